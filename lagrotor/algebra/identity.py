"""Decision whether an expression vanishes identically: exactly in a class, by a point or by a proof beyond it.

Beyond the class below, a point at which an enclosure excludes zero refutes (`lagrotor.algebra.refutation`), and zero is proved
by translation into the class, by induction or by derivatives (`lagrotor.algebra.analytic_proofs`); where neither ends, or only
on a branch (`lagrotor.algebra.branches`), the decision says so.

The class: sums, products and integer powers of symbols, rationals, pi, i, square roots of rational functions of the
symbols with rational coefficients, |x| of real x, and of

    sin, cos, tan, cot, sec, csc, sinh, cosh, tanh, coth, sech, csch, exp

whose arguments are rational combinations of monomials in the symbols (x, x/2, omega*t), the circular ones also of
rational multiples of pi.  Every angle is a whole multiple of a base angle u, one for each monomial, so by the
addition theorems everything is a quotient of polynomials in the generators, subject to

    sin(u)**2 = 1 - cos(u)**2,    sinh(u)**2 = cosh(u)**2 - 1,    sqrt(p)**2 = p,    i**2 = -1.

Exponentials of rationally independent monomials are algebraically independent over the rational functions, and no
product of the radicands of the generators is a square (`lagrotor.algebra.roots`).  Hence there are no other relations,
the quotient ring has no zero divisors, and a quotient vanishes identically if and only if its numerator, reduced to
degree below two in every squared generator, is the zero polynomial.

Square roots are principal ones.  One that follows from the others has a sign, which may differ between regions of the
symbols' values, and the expression is decided for each choice of these signs.  "nonzero" means: not zero throughout.
A symbol of which nothing is declared is taken to be real where a point is needed.  Symbols are real: a point where some part
is not real is no counterexample, unless the expression has i or a complex symbol, or is real at no inner point; then
principal values are meant.  The work is bounded; an expression
that would exceed the bound is undecided.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import product
from math import inf
from typing import Any, Literal

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
from lagrotor.algebra.refutation import find_witness
from lagrotor.algebra.scalar import node_count, scalar, sympified
from lagrotor.algebra.signs import BRANCHED, Region, conditions, region
from lagrotor.algebra.work_budget import bounded_cache
from lagrotor.errors import InputError, NotExactError, TooLargeError

# A divisor larger than this is kept whole in the domain: its factors may take hours to find.
_MOST_TERMS, _MOST_DEGREE = 40, 12
# A normal form is not sought of larger polynomials: their common divisor may take hours to find.
_MOST_NORMAL = 3000
# Roots whose sign is not known, each of which doubles the work, and points at which their signs are looked at.
_MOST_SIGNS, _SIGN_POINTS = 3, 64
_MOST_PARTS = 4000  # of an expression that is translated
_EXCLUDED = "An enclosure at the witness excludes zero."


@dataclass(frozen=True)
class Decision:
    """Whether an expression vanishes identically, where that holds, and what shows it.

    `domain` holds the factors that must not vanish. `partly`: a nonzero expression that vanishes for some signs of its
    roots, as sqrt(x**2) - x does on the branch x >= 0. `seen`: an expression that is not zero throughout, to be evaluated at
    the points `at`, or at random ones, when a witness or evidence is read.
    """

    answer: Literal["zero", "nonzero", "undecided"]
    domain: tuple[sp.Expr, ...]
    reason: str
    partly: bool = False
    residual: sp.Expr | None = None
    points: tuple[Point, ...] | None = None
    conditions: Callable[[], Iterable[sp.Basic]] = field(default=tuple, compare=False, repr=False)

    @cached_property
    def branch(self) -> tuple[sp.Basic, ...]:
        """Inequalities under which the expression is proved to vanish, searched for when they are read."""
        return tuple(self.conditions())

    @property
    def witness(self) -> Mapping[sp.Expr, sp.Rational] | None:
        """A point where a nonzero expression does not vanish, with the values that unknown functions take there."""
        return self._largest[0] if self.answer == "nonzero" else None

    @property
    def evidence(self) -> float | None:
        """The largest absolute value at the points, of a nonzero or an undecided expression."""
        return self._largest[1]

    @property
    def _largest(self) -> tuple[Point | None, float | None]:
        return (None, None) if self.residual is None else largest_value(self.residual, self.points)


def decide_zero(expression: sp.Expr, assumptions: Iterable[Any] = ()) -> Decision:
    """Decide expression = 0; with floats in it, beyond the bound on the work and where nothing proves it "undecided".

    Parameters
    ----------
    assumptions : Iterable[Any], default ()
        Inequalities that hold of the symbols, x > 0, besides what these are declared to be.

    Raises
    ------
    InputError
        For what is not a scalar expression, for two symbols of one name, and for what is no inequality.
    """
    try:
        expression = scalar(expression, "decide_zero")
    except NotExactError as refusal:
        return Decision("undecided", (), str(refusal))
    return _decide(expression, region(assumptions))


@bounded_cache(1024)
def _decide(expression: sp.Expr, where: Region) -> Decision:
    """Decide an equation, not how it is written: up to a number before it, with its symbols numbered."""
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
        points=None
        if places is None
        else tuple({numbering.to_input(s): value for s, value in point.items()} for point in places),
        conditions=lambda: map(numbering.to_input, decision.branch),
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
    """Return whether something in it is not exact, not finite or does not commute."""
    limits = {end for node in expression.atoms(sp.Integral, sp.Sum) for limit in node.limits for end in limit[1:]}
    return any(
        atom.is_Float or not atom.is_commutative or (atom.is_finite is False and atom not in limits) or atom is sp.nan
        for atom in expression.atoms()
    )


def _by_a_point(expression: sp.Expr, where: Region, exact: Decision) -> Decision:
    witness, _ = find_witness(expression, where)
    if witness is None or not witness.real:
        return exact
    return Decision("nonzero", (), _EXCLUDED, residual=expression, points=(witness.point,))


def _by_analysis(expression: sp.Expr, where: Region, exact: Decision) -> Decision:
    """By a point whose enclosure excludes zero; by proof; on the branch where what a proof wants holds."""
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
        return replace(exact, reason="No point was seen at which it is defined.")
    if exact.answer == "nonzero":
        return replace(exact, conditions=lambda: _inside(branch_of_zero(plain, where, proof.missing)[0], exact.domain))
    branch, branch_proof = branch_of_zero(plain, where, proof.missing)
    inside = _inside(branch, branch_proof.divisors)
    if witness is None:
        if branch_proof.how is not None and set(branch) <= set(simplify_conditions(conditions(plain), where)):
            return Decision("zero", branch_proof.divisors, branch_proof.how or "", conditions=lambda: branch)
        return replace(exact, reason=reason, conditions=lambda: inside)
    if not (branch or witness.real or has_principal_values(plain, (), where)):
        return replace(exact, reason="It differs from zero where it is not real, and was not proved where it is.")
    return Decision(
        "nonzero", branch_proof.divisors, _EXCLUDED, bool(branch), plain, (witness.point,), conditions=lambda: inside
    )


def _inside(branch: tuple[sp.Basic, ...], domain: tuple[sp.Expr, ...]) -> tuple[sp.Basic, ...]:
    """Return x > 0 for x >= 0 where x must not vanish."""
    apart = {sp.expand(sign * factor) for factor in domain for sign in (1, -1)}
    return tuple(r.func(r.lhs, r.rhs) if (e := r.gts - r.lts) not in apart else sided(e, True) for r in branch)


# Of the differences that a paper's audit decides, three in five come again under other premises.
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


def decide_equal(
    lhs: sp.Expr | sp.MatrixBase, rhs: sp.Expr | sp.MatrixBase, assumptions: Iterable[Any] = ()
) -> Decision:
    """Decide left = right; matrices are equal if every entry is, and unequal if any is.

    Parameters
    ----------
    lhs : Expr or MatrixBase
        An expression or a matrix.
    rhs : Expr or MatrixBase
        Likewise.
    assumptions : Iterable[Any], default ()
        Inequalities, as of `decide_zero`.

    Raises
    ------
    InputError
        The two differ in shape, or are no expressions; two symbols of one name.

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


def normal_form(expression: sp.Expr) -> sp.Expr:
    """Return the expression as a coprime quotient P/Q in sin and cos of the base angles.

    P is of degree below two in every squared generator and Q is free of them, which makes P/Q unique for given base
    angles (x itself, or x/n if the expression has n-th parts of x) and roots.

    Raises
    ------
    NotExactError
        Outside the class, and for roots whose sign differs between regions.
    InputError
        For what is not a scalar expression.
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
        raise NotExactError(f"Its normal form is too large: terms {len(numerator)} over {len(denominator)}.")
    numerator, denominator = numerator.cancel(denominator)
    return ring.expression(numerator) / ring.expression(denominator)


def _domain(ring: Ring) -> tuple[sp.Expr, ...]:
    """Return the distinct factors of everything divided by, as functions of the input."""
    factors = [
        factor
        for divisor, name in ring.divisors.items()
        for factor in (_irreducible(ring, divisor) if name is None else [name])
        if factor.free_symbols
    ]
    return tuple(dict.fromkeys(factors))


def _monic(factor: sp.Expr) -> sp.Expr:
    """Return a polynomial over its leading coefficient, the symbols in the order of their names: for reading only.

    |u| and a root of u vanish where u does, which is returned for them.
    """
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
            # 1 - cos**2 vanishes where the sine does, which says it more plainly.
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


# Most divisors of a paper's audit come again in another identity.
@lru_cache(maxsize=1024)
def _factors(names: tuple[sp.Expr, ...], terms: frozenset[tuple[tuple[int, ...], Any]]) -> tuple[sp.Expr, ...]:
    """The irreducible factors of a polynomial in these names, each once."""
    ring = Ring(names)
    return tuple(ring.expression(factor) for factor, _ in ring.polynomials.from_dict(dict(terms)).factor_list()[1])
