"""Decision whether an expression vanishes identically.

The decision is exact for sums, products and integer powers of symbols, rationals, pi, i, |x| of real x, square roots of
rational functions of the symbols with rational coefficients, and of

    sin, cos, tan, cot, sec, csc, sinh, cosh, tanh, coth, sech, csch, exp

whose arguments are rational combinations of monomials in the symbols (x, x/2, omega*t); the circular functions also take
rational multiples of pi.  Every angle is a whole multiple of the base angle u of its monomial.  By the addition theorems the
expression is a quotient of polynomials in the generators, subject to

    sin(u)**2 = 1 - cos(u)**2,    sinh(u)**2 = cosh(u)**2 - 1,    sqrt(p)**2 = p,    i**2 = -1.

The generators obey no other relation: exponentials of rationally independent monomials are algebraically independent, and no
product of the radicands is a square (`roots`).  The quotient ring has no zero divisors, so a quotient vanishes identically if
and only if its numerator, reduced to degree below two in every squared generator, is the zero polynomial.

Outside this class a point where an enclosure excludes zero is a counterexample (`refutation`); `analytic_proofs` proves zero.

Square roots are principal values.  A root that follows from other roots has a sign, which may differ from region to region;
"nonzero" means that the expression does not vanish for every choice of these signs.  A symbol without assumptions is taken to
be real where a point is needed.  A point where a subexpression is not real is no counterexample, unless the expression has i or
a complex symbol, or is real at no inner point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from itertools import product
from math import inf
from typing import TYPE_CHECKING, Any, Literal

import sympy as sp
from sympy.polys.rings import PolyElement

from lagrotor.algebra.analytic_proofs import Proof, evaluated, proof_of_zero
from lagrotor.algebra.branches import branch_of_zero, sided, simplify_conditions
from lagrotor.algebra.enclosures import Point
from lagrotor.algebra.evidence import largest_value, points
from lagrotor.algebra.feasibility import has_principal_values
from lagrotor.algebra.generators import survey
from lagrotor.algebra.name_clashes import check_names
from lagrotor.algebra.numbering import Numbering, without_number
from lagrotor.algebra.quotients import Ring
from lagrotor.algebra.reading import Roots, find_roots, reader
from lagrotor.algebra.refutation import find_witness, is_refuted
from lagrotor.algebra.scalar import node_count, scalar, sympified
from lagrotor.algebra.signs import BRANCHED, Region, conditions, region
from lagrotor.algebra.work_budget import bounded_cache
from lagrotor.errors import InputError, NotExactError, TooLargeError
from lagrotor.renamed import accept_old_keywords, old_attribute
from lagrotor.result_display import Shown

# A larger divisor is not factored in the domain: this may take hours.
_MOST_TERMS, _MOST_DEGREE = 40, 12
# No normal form is computed of larger polynomials: their common divisor may take hours.
_MOST_NORMAL = 3000
# Roots of unknown sign, each of which doubles the work; points at which their signs are evaluated.
_MOST_SIGNS, _SIGN_POINTS = 3, 64
_MOST_PARTS = 4000  # nodes of an expression that is translated
_EXCLUDED = "An enclosure at the witness excludes zero."


@dataclass(frozen=True, repr=False)
class Decision(Shown):
    """The decision whether an expression vanishes identically, with its domain and its evidence.

    Attributes
    ----------
    answer : str
        "zero", "nonzero" (not zero at every point) or "undecided".
    domain : tuple of Expr
        Factors that must not vanish.
    reason : str
        The reason of the answer, one sentence.
    partly : bool
        True for a nonzero expression that vanishes on a branch: sqrt(x**2) - x vanishes for x >= 0.
    residual : Expr or None
        The expression that `witness` and `evidence` evaluate.
    points : tuple of dict or None
        Points at which the residual is evaluated; if None, random points are taken.
    conditions : Callable
        A function that searches for the inequalities of `branch`; it is called when `branch` is read.

    Examples
    --------
    >>> from sympy import symbols
    >>> x = symbols("x", positive=True)
    >>> decide_zero((x**2 - 1)/(x - 1) - x - 1).domain, decide_zero(x**2 - x).witness
    ((x - 1,), {x: 772/499})
    """

    _shown = (
        ("answer", "answer"),
        ("where not zero", "domain"),
        ("reason", "reason"),
        ("a point", "witness"),
    )

    answer: Literal["zero", "nonzero", "undecided"]
    domain: tuple[sp.Expr, ...]
    reason: str
    partly: bool = False
    residual: sp.Expr | None = None
    points: tuple[Point, ...] | None = None
    conditions: Callable[[], Iterable[sp.Basic]] = field(default=tuple, compare=False, repr=False)

    if not TYPE_CHECKING:
        __getattr__ = old_attribute

    @cached_property
    def branch(self) -> tuple[sp.Basic, ...]:
        """The inequalities under which the expression is proved to vanish; empty if none are known."""
        return tuple(self.conditions())

    @property
    def witness(self) -> Mapping[sp.Expr, sp.Rational] | None:
        """A point {symbol or function value: number} at which a nonzero expression does not vanish; None otherwise."""
        return self._largest[0] if self.answer == "nonzero" else None

    @property
    def evidence(self) -> float | None:
        """The largest |residual| at `points`, for a nonzero or undecided expression; None if no value is known."""
        return self._largest[1]

    @property
    def _largest(self) -> tuple[Point | None, float | None]:
        return (None, None) if self.residual is None else largest_value(self.residual, self.points)


@accept_old_keywords
def decide_zero(expression: sp.Expr, assumptions: Iterable[Any] = ()) -> Decision:
    """Decide whether an expression vanishes identically.

    The answer is "undecided" if the expression contains floats, if the decision takes too much work, or if no proof is known.

    Parameters
    ----------
    expression : Expr
        A scalar expression.
    assumptions : iterable of inequality, default ()
        Inequalities between the symbols, such as x > 0, besides the assumptions with which the symbols were declared.

    Returns
    -------
    Decision
        The answer, its reason, the domain, and the counterexample of a nonzero expression.

    Raises
    ------
    InputError
        If the expression is not a scalar, two symbols share a name, or an assumption is not an inequality.

    Examples
    --------
    >>> from sympy import cos, sin, sqrt, symbols
    >>> x = symbols("x", real=True)
    >>> decide_zero(sin(2*x) - 2*sin(x)*cos(x)).answer
    'zero'
    >>> decision = decide_zero(sqrt(x**2) - x)
    >>> decision.answer, decision.branch, decide_zero(sqrt(x**2) - x, assumptions=[x > 0]).answer
    ('nonzero', (x >= 0,), 'zero')
    """
    try:
        expression = scalar(expression, "decide_zero")
    except NotExactError as refusal:
        return Decision("undecided", (), str(refusal))
    return _decide(expression, region(assumptions))


@bounded_cache(1024)
def _decide(expression: sp.Expr, where: Region) -> Decision:
    """Decide the equation independently of a numerical factor and of the names of its symbols."""
    number, form = without_number(expression)
    numbering = Numbering(form, *(e for e, _ in where.above))
    numbered = Region(tuple((numbering.to_numbered(e), strict) for e, strict in where.above))
    decision = _decide_numbered(numbering.to_numbered(form), numbered)
    residual, places = decision.residual and numbering.to_input(decision.residual), decision.points
    if residual is not None and number != 1:
        residual = sp.Mul(number, residual, evaluate=False)
    return replace(
        decision,
        domain=tuple(_monic(numbering.to_input(factor)) for factor in decision.domain),
        reason=numbering.text(decision.reason),
        residual=residual,
        points=places and tuple({numbering.to_input(s): value for s, value in point.items()} for point in places),
        conditions=partial(_branch_of, decision, numbering),
    )


@bounded_cache(1024)
def _decide_numbered(expression: sp.Expr, where: Region) -> Decision:
    try:
        exact = _decide_in_ring(expression)
        if exact.answer == "zero" or not exact.partly:
            return exact
    except TooLargeError as refusal:
        return _by_a_point(expression, where, Decision("undecided", (), str(refusal), residual=expression))
    except NotExactError as refusal:
        exact = Decision("undecided", (), str(refusal), residual=expression)
    if _is_foreign(expression):
        return exact
    if node_count(expression) > _MOST_PARTS:
        return _by_a_point(expression, where, exact)
    return _by_analysis(expression, where, exact)


def _is_foreign(expression: sp.Expr) -> bool:
    """Return True if some atom is a float, does not commute, or is infinite outside the limits of a sum or integral."""
    limits = {end for node in expression.atoms(sp.Integral, sp.Sum) for limit in node.limits for end in limit[1:]}
    return any(
        atom.is_Float or not atom.is_commutative or (atom.is_finite is False and atom not in limits) or atom is sp.nan
        for atom in expression.atoms()
    )


def _by_a_point(expression: sp.Expr, where: Region, exact: Decision) -> Decision:
    """Return a refutation by a real counterexample; if no counterexample is known, return the decision `exact`."""
    witness, _ = find_witness(expression, where)
    if witness is None or not witness.real:
        return exact
    return Decision("nonzero", (), _EXCLUDED, residual=expression, points=(witness.point,))


def _by_analysis(expression: sp.Expr, where: Region, exact: Decision) -> Decision:
    """Decide by a counterexample or by a proof; otherwise search for a branch on which a proof holds.

    `exact` is the decision that the exact procedure reached before.
    """
    plain, proof, reason = evaluated(expression, where), Proof(None), exact.reason
    witness, enclosed = find_witness(plain, where)
    branched = (n for n in plain.atoms(*BRANCHED, sp.Pow) if not (n.is_Pow and n.exp.is_integer))
    if witness is None or any(n.free_symbols for n in branched):
        try:
            proof = proof_of_zero(plain, where)
        except NotExactError as refusal:
            reason = str(refusal)
    if witness is None and proof.how is not None:
        if enclosed or not plain.free_symbols:
            return Decision("zero", proof.divisors, proof.how)
        return replace(exact, reason="No point is known at which it is defined.")
    if exact.answer == "nonzero":
        return replace(exact, conditions=partial(_branch_inside, plain, where, proof.missing, exact.domain))
    branch, branch_proof = branch_of_zero(plain, where, proof.missing)
    inside = _inside(branch, branch_proof.divisors)
    if witness is None:
        if branch_proof.how is not None and set(branch) <= set(simplify_conditions(conditions(plain), where)):
            return Decision("zero", branch_proof.divisors, branch_proof.how or "", conditions=partial(tuple, branch))
        return replace(exact, reason=reason, conditions=partial(tuple, inside))
    if not (branch or witness.real or has_principal_values(plain, (), where)):
        return replace(exact, reason="It is not zero where it is not real, and no proof is known where it is real.")
    return Decision(
        "nonzero",
        branch_proof.divisors,
        _EXCLUDED,
        bool(branch),
        plain,
        (witness.point,),
        conditions=partial(tuple, inside),
    )


def _branch_of(decision: Decision, numbering: Numbering) -> list[sp.Basic]:
    """Return the branch of a decision about numbered symbols in the symbols of the input."""
    return [numbering.to_input(condition) for condition in decision.branch]


def _branch_inside(plain: sp.Expr, where: Region, missing: Any, domain: tuple[sp.Expr, ...]) -> tuple[sp.Basic, ...]:
    """Return the conditions on which an expression vanishes, as far as they meet its domain."""
    return _inside(branch_of_zero(plain, where, missing)[0], domain)


def _inside(branch: tuple[sp.Basic, ...], domain: tuple[sp.Expr, ...]) -> tuple[sp.Basic, ...]:
    """Make an inequality x >= 0 of a branch strict if x is in the domain, whose factors must not vanish."""
    apart = {sp.expand(sign * factor) for factor in domain for sign in (1, -1)}
    return tuple(r.func(r.lhs, r.rhs) if (e := r.gts - r.lts) not in apart else sided(e, True) for r in branch)


# Three in five differences of a paper's audit recur under other premises.
@bounded_cache(1024)
def _decide_in_ring(expression: sp.Expr) -> Decision:
    content = survey(expression)
    roots = find_roots(content)
    if len(roots.unsigned) > _MOST_SIGNS:
        raise TooLargeError(f"More than {_MOST_SIGNS} roots have a sign that may differ from region to region.")
    domain: tuple[sp.Expr, ...] = ()
    zero, nonzero = set[tuple[int, ...]](), dict[tuple[int, ...], str]()
    for signs in product((1, -1), repeat=len(roots.unsigned)):
        reading = reader(content, roots, signs)
        numerator, ring = reading.quotient(expression).numerator, reading.ring
        domain += _domain(ring)
        if numerator:
            leading = ring.expression(ring.polynomials.from_dict(dict([numerator.terms()[0]])))
            nonzero[signs] = f"The reduced numerator is not zero: terms {len(numerator)}, the leading one {leading}."
        else:
            zero.add(signs)
    domain = tuple(dict.fromkeys(domain))
    if not nonzero:
        return Decision("zero", domain, "The reduced numerator is the zero polynomial.")
    if not zero:
        return Decision("nonzero", domain, next(iter(nonzero.values())), residual=expression)
    samples = [(roots.signs_at(point), point) for point in points(expression.free_symbols, _SIGN_POINTS)]
    for signs, reason in nonzero.items():
        if witnesses := tuple(point for sample_signs, point in samples if sample_signs == signs):
            return Decision("nonzero", domain, reason, True, expression, witnesses)
    raise NotExactError(f"It vanishes for some signs of {_listed(roots)} and not for others.")


def _listed(roots: Roots) -> str:
    return ", ".join(str(sp.sqrt(root.base)) for root in roots.unsigned)


@accept_old_keywords
def decide_equal(
    lhs: sp.Expr | sp.MatrixBase, rhs: sp.Expr | sp.MatrixBase, assumptions: Iterable[Any] = ()
) -> Decision:
    """Decide whether two expressions or matrices are equal; matrices are equal if every entry is.

    Parameters
    ----------
    lhs : Expr or Matrix
        The left-hand side.
    rhs : Expr or Matrix
        The right-hand side, of the same shape.
    assumptions : iterable of inequality, default ()
        Inequalities between the symbols, such as x > 0, besides the assumptions with which the symbols were declared.

    Returns
    -------
    Decision
        The decision on lhs - rhs. For matrices it is the decision on the first nonzero entry, else on the first undecided one.

    Raises
    ------
    InputError
        If the shapes differ, a side is not an expression, or two symbols share a name.

    Examples
    --------
    >>> from sympy import log, symbols
    >>> x = symbols("x", positive=True)
    >>> decide_equal(log(x**2), 2*log(x)).answer, decide_equal(x**2/x, x + 1).answer
    ('zero', 'nonzero')
    """
    lhs, rhs = sympified(lhs, "decide_equal"), sympified(rhs, "decide_equal")
    shapes = getattr(lhs, "shape", ()), getattr(rhs, "shape", ())
    if shapes[0] != shapes[1]:
        raise InputError(f"decide_equal: shapes {shapes[0]} and {shapes[1]} cannot be compared")
    where = region(assumptions)
    if not isinstance(lhs, sp.MatrixBase):
        return _decide_difference(lhs, rhs, where)
    entries = [_decide_difference(a, b, where) for a, b in zip(lhs, rhs, strict=True)]
    domain = tuple(dict.fromkeys(factor for entry in entries for factor in entry.domain))
    for answer in ("nonzero", "undecided"):
        for place, entry in enumerate(entries):
            if entry.answer == answer:
                row, column = divmod(place, lhs.cols)
                reason = f"Entry ({row + 1}, {column + 1}): {entry.reason}"
                return replace(entry, domain=domain, reason=reason)
    return Decision("zero", domain, "The reduced numerator of every entry is the zero polynomial.")


def _decide_difference(lhs: sp.Expr, rhs: sp.Expr, where: Region) -> Decision:
    try:
        lhs, rhs = scalar(lhs, "decide_equal"), scalar(rhs, "decide_equal")
    except NotExactError as refusal:
        return Decision("undecided", (), str(refusal))
    check_names("decide_equal", lhs, rhs)
    return _decide(lhs - rhs, where)


def differ(lhs: sp.Expr | sp.MatrixBase, rhs: sp.Expr | sp.MatrixBase, assumptions: Iterable[Any] = ()) -> bool:
    """Return True if enclosures separate two real sides of one shape at a point; this takes less time than a decision."""
    where = region(assumptions)
    pairs = zip(lhs, rhs, strict=True) if isinstance(lhs, sp.MatrixBase) else [(lhs, rhs)]
    try:
        return any(is_refuted(scalar(a - b, "differ"), where) for a, b in pairs)
    except NotExactError:
        return False


def are_equal(lhs: sp.Expr | sp.MatrixBase, rhs: sp.Expr | sp.MatrixBase, assumptions: Sequence[Any] = ()) -> bool:
    """Return True if two sides of one shape are proved to be equal."""
    return not differ(lhs, rhs, assumptions) and decide_equal(lhs, rhs, assumptions).answer == "zero"


def normal_form(expression: sp.Expr) -> sp.Expr:
    """Return the expression as a coprime quotient P/Q in the sines and cosines of the base angles.

    P has degree below two in every squared generator and Q is free of them.  P/Q is unique for fixed roots and base angles: x
    itself, or x/n if the expression contains n-th parts of x.

    Parameters
    ----------
    expression : Expr
        A scalar expression.

    Returns
    -------
    Expr
        The quotient.

    Raises
    ------
    NotExactError
        If the expression is outside the class, or the sign of a root differs between regions.
    InputError
        If the expression is not a scalar.

    Examples
    --------
    >>> from sympy import cos, sin, symbols
    >>> x = symbols("x")
    >>> normal_form((1 - cos(x)**2)/sin(x)), normal_form(sin(x)**4 + cos(x)**2*sin(x)**2)
    (sin(x), 1 - cos(x)**2)
    """
    expression = scalar(expression, "normal_form")
    content = survey(expression, largest=inf)
    roots = find_roots(content)
    if roots.unsigned:
        raise NotExactError(f"The signs of {_listed(roots)} may differ from region to region.")
    reading = reader(content, roots)
    ring, (numerator, factors) = reading.ring, reading.quotient(expression)
    denominator = ring.expanded(factors)
    for index in ring.squares:
        # A + B*g times its conjugate A - B*g is free of g.
        conjugate = ring.polynomials.from_dict({m: -c if m[index] else c for m, c in denominator.terms()})
        if conjugate != denominator:
            numerator, denominator = ring.product(numerator, conjugate), ring.product(denominator, conjugate)
    if len(numerator) + len(denominator) > _MOST_NORMAL:
        raise NotExactError(f"The normal form is too large: {len(numerator)} terms over {len(denominator)} terms.")
    numerator, denominator = numerator.cancel(denominator)
    return ring.expression(numerator) / ring.expression(denominator)


def _domain(ring: Ring) -> tuple[sp.Expr, ...]:
    """Return the factors that must not vanish: the distinct irreducible factors of all divisors."""
    factors = [
        factor
        for divisor, name in ring.divisors.items()
        for factor in (_irreducible(ring, divisor) if name is None else [name])
        if factor.free_symbols
    ]
    return tuple(dict.fromkeys(factors))


def _monic(factor: sp.Expr) -> sp.Expr:
    """Simplify a factor, keeping its zeros: divide a polynomial by its leading coefficient; replace |u| and roots of u by u."""
    while isinstance(factor, sp.Abs) or (factor.is_Pow and factor.exp.is_Rational and factor.exp > 0):
        factor = factor.args[0]
    if not factor.is_Add or not (polynomial := factor.as_poly()):
        return factor
    leading = polynomial.reorder(*sorted(polynomial.gens, key=sp.default_sort_key)).LC()
    return sp.expand(factor / leading) if leading.is_Rational else factor


def _irreducible(ring: Ring, polynomial: PolyElement) -> list[sp.Expr]:
    factors = []
    for index, square in ring.squares.items():
        if ring.names[index].func in (sp.sin, sp.sinh):
            # 1 - cos**2 vanishes where the sine does; the sine is simpler.
            quotient, remainder = polynomial.div(square)
            if not remainder:
                factors.append(ring.names[index])
                polynomial = quotient
        elif polynomial == ring.polynomials.gens[index]:
            polynomial = square  # a root vanishes where its radicand does
    named = ring.divisors.get(polynomial.monic())
    if named is not None:
        return [*factors, named]
    if len(polynomial) == 1:
        [monomial] = polynomial.itermonoms()
        return factors + [name for name, power in zip(ring.names, monomial, strict=True) if power]
    if len(polynomial) > _MOST_TERMS or max(map(sum, polynomial.itermonoms())) > _MOST_DEGREE:
        return [*factors, ring.expression(polynomial)]
    used = [i for i, powers in enumerate(zip(*polynomial.itermonoms(), strict=True)) if any(powers)]
    terms = frozenset((tuple(monomial[i] for i in used), c) for monomial, c in polynomial.iterterms())
    return [*factors, *_factors(tuple(ring.names[i] for i in used), terms)]


# Most divisors of a paper's audit recur in another identity.
@lru_cache(maxsize=1024)
def _factors(names: tuple[sp.Expr, ...], terms: frozenset[tuple[tuple[int, ...], Any]]) -> tuple[sp.Expr, ...]:
    """Return the distinct irreducible factors of a polynomial, given by its generators and its terms (exponents, coefficient)."""
    ring = Ring(names)
    return tuple(ring.expression(factor) for factor, _ in ring.polynomials.from_dict(dict(terms)).factor_list()[1])
