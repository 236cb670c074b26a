"""The Coq certificate of one equation: the file that states and proves the verdict of each line.

Each line is a theorem over the reals. Its symbols are variables. Declared signs, premises, and the conditions under which
both sides have a value are hypotheses. The conclusion is printed = derived; for a refuted line it is a point at which all
hypotheses hold and the enclosure of the difference excludes zero. A line that holds has a second theorem, that its
hypotheses hold at some point, since contradictory ones imply anything.

The printed side comes from the catalogue, the derived side from the script, both without substitution of premises.
Premises and the values of a scene are equations among the hypotheses. A symbol that a premise scales, such as F in F =
epsilon*F, is a new symbol on the right.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from lagrotor.errors import NotExactError
from lagrotor.paper.catalogue import Equation
from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import Answer, LineVerdict, Verdict
from lagrotor.proofs.coq.cofactors import SymbolEquation, elimination
from lagrotor.proofs.coq.coq_terms import Comparison, Terms, comment, comparison, conditions_of_value, declared_signs
from lagrotor.proofs.coq.equality_steps import Sides, in_one
from lagrotor.proofs.coq.points import points_of, rational_bounds, value_at_point
from lagrotor.proofs.coq.remainders import SeriesRemainder, remainder, value_at_zero

PREAMBLE = """From Coq Require Import Reals Lra.
From Interval Require Import Tactic.
Open Scope R_scope.

Lemma sine_and_cosine (x : R) : sin x ^ 2 + cos x ^ 2 - 1 = 0.
Proof. generalize (sin2_cos2 x). unfold Rsqr. lra. Qed.
Lemma root_squared (x : R) : 0 <= x -> sqrt x ^ 2 - x = 0.
Proof. intro h. generalize (sqrt_sqrt x h). lra. Qed.
Lemma size_squared (x : R) : Rabs x ^ 2 - x ^ 2 = 0.
Proof. rewrite pow2_abs. ring. Qed.
Lemma a_letter_for (x : R) : exists y, y = x.
Proof. exists x. reflexivity. Qed.
Lemma by_cofactors (left right n d : R) : d <> 0 -> (left - right) * d = n -> n = 0 -> left = right.
Proof. intros h e z. rewrite z in e. destruct (Rmult_integral _ _ e) as [w | w]; [lra | contradiction]. Qed.
Lemma by_premise (left right d n : R) : left = right -> n = (left - right) * d -> n = 0.
Proof. intros e h. rewrite h, e. ring. Qed.
Lemma same_by_squares (a b : R) : 0 <= a -> 0 <= b -> a ^ 2 = b ^ 2 -> a = b.
Proof. intros h k e. apply Rsqr_inj; [assumption | assumption | unfold Rsqr; lra]. Qed.
Lemma sine_below (x : R) : 0 <= x -> sin x <= x.
Proof. intros [h | h]; [apply Rlt_le, sin_lt_x, h | subst x; rewrite sin_0; lra]. Qed.
Lemma sine_is_small (x : R) : Rabs (sin x) <= Rabs x.
Proof.
  assert (half : forall y, 0 <= y -> Rabs (sin y) <= y).
  { intros y h. destruct (Rle_lt_dec y 1) as [k | k].
    - rewrite Rabs_pos_eq; [apply sine_below, h |].
      apply sin_ge_0; [exact h | generalize PI_4; generalize PI2_3_2; lra].
    - generalize (SIN_bound y). intros [l u]. apply Rabs_le. lra. }
  destruct (Rle_lt_dec 0 x) as [h | h].
  - rewrite (Rabs_pos_eq x h). apply half, h.
  - rewrite <- (Rabs_Ropp x), <- Rabs_Ropp, <- sin_neg, (Rabs_pos_eq (- x)); [apply half |]; lra.
Qed.
Lemma more_than_zero (x : R) : 0 < x -> x <> 0.
Proof. lra. Qed.
Ltac positive := first [assumption | lazymatch goal with
  | |- 0 < _ + _ => first [apply Rplus_lt_0_compat; positive | apply Rplus_lt_le_0_compat; positive
    | apply Rplus_le_lt_0_compat; positive]
  | |- 0 <= _ + _ => apply Rplus_le_le_0_compat; positive
  | |- 0 < _ * _ => apply Rmult_lt_0_compat; positive
  | |- 0 <= _ * _ => apply Rmult_le_pos; positive
  | |- 0 < _ / _ => apply Rdiv_lt_0_compat; positive
  | |- 0 <= _ / _ => unfold Rdiv; apply Rmult_le_pos; [positive | apply Rlt_le, Rinv_0_lt_compat; positive]
  | |- 0 < / _ => apply Rinv_0_lt_compat; positive
  | |- 0 <= / _ => apply Rlt_le, Rinv_0_lt_compat; positive
  | |- 0 < _ ^ _ => apply pow_lt; positive
  | |- 0 <= _ ^ _ => first [apply pow2_ge_0 | apply pow_le; positive]
  | |- 0 < sqrt _ => apply sqrt_lt_R0; positive
  | |- 0 <= sqrt _ => apply sqrt_pos
  | |- 0 < exp _ => apply exp_pos
  | |- 0 < PI => apply PI_RGT_0
  | |- _ => lra end].
Ltac apart := repeat apply conj; repeat first [assumption | apply Rmult_integral_contrapositive_currified
  | apply pow_nonzero | apply Rinv_neq_0_compat | lra | apply more_than_zero; positive].
Ltac same := first [ring | field; apart].
Ltac circular := repeat first [rewrite sin_plus | rewrite cos_plus | rewrite sin_neg | rewrite cos_neg | rewrite sin_PI2
  | rewrite cos_PI2 | rewrite sin_0 | rewrite cos_0].
Ltac exponential := repeat first [rewrite exp_plus | rewrite exp_Ropp | rewrite exp_0].
Ltac at_the_point := repeat apply conj; first [lra | field; lra | interval | apply Rgt_not_eq; interval
  | apply Rlt_not_eq; interval | unfold Rpower; interval].
"""


# The name of the text's values among the premises of a line.
SCENE = "the text's values"
Theorems = tuple[tuple[str, ...], str]  # names and text


@dataclass(frozen=True)
class Proposition:
    """One line of an equation, or of its correction.

    `name` is line_1 or correction_1, as in the name of its theorem. `equations` are the premises and scene values, each as
    (words, left, right), on which the line rests; for a refuted line they are all that were offered. `region` has the
    inequalities of these premises. `stands_for` gives the symbol of each derivative and integral, which are unknowns.
    `tolerance` is the largest relative error of a number read off a run. `small` and `order` belong to a series.
    """

    name: str
    quantity: str
    verdict: Answer
    printed: Any
    derived: Any
    equations: tuple[tuple[str, sp.Expr, sp.Expr], ...] = ()
    region: tuple[sp.Basic, ...] = ()
    stands_for: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    tolerance: sp.Rational | None = None
    small: sp.Symbol | None = None
    order: int | None = None

    @property
    def pairs(self) -> tuple[tuple[sp.Expr, sp.Expr], ...]:
        """The pairs (printed, derived), entry by entry."""
        if isinstance(self.printed, sp.MatrixBase) and isinstance(self.derived, sp.MatrixBase):
            return tuple(zip(self.printed, self.derived, strict=True))
        return ((self.printed, self.derived),)


def propositions(verdict: Verdict) -> Iterator[Proposition]:
    """Yield every printed line of an equation, then every line of its correction."""
    for kind, lines in (("line", verdict.lines), ("correction", verdict.correction_lines)):
        for number, line in enumerate(lines, 1):
            yield _proposition(f"{kind}_{number}", line, verdict.statement.premises)


def _proposition(name: str, line: LineVerdict, offered: tuple[Premise, ...]) -> Proposition:
    relation = line.relation
    premises = offered if line.verdict == "refuted" else line.premises
    set_otherwise = {old for premise in premises if premise.small is None for old in premise.put}
    rows = [
        (premise.says, old, new)
        for premise in premises
        for old, new in _unscaled(premise)
        if premise.small is None or old not in set_otherwise  # a symbol that is zero need not be small
    ]
    where = [condition for premise in premises for condition in premise.where]
    rows += [(str(condition), condition.lhs, condition.rhs) for condition in where if isinstance(condition, sp.Eq)]
    rows += [(SCENE, old, new) for old, new in relation.scene.items()]
    rows = [(says, sp.sympify(old, strict=True), sp.sympify(new, strict=True)) for says, old, new in rows]
    expressions = [relation.printed, relation.derived, *where, *(side for _, *sides in rows for side in sides)]
    symbols = _symbols_for_operators(expressions)
    return Proposition(
        name,
        relation.quantity,
        line.verdict,
        relation.printed.xreplace(symbols),
        relation.derived.xreplace(symbols),
        tuple((says, old.xreplace(symbols), new.xreplace(symbols)) for says, old, new in rows),
        tuple(condition.xreplace(symbols) for condition in where if not isinstance(condition, sp.Eq)),
        tuple((symbol, node) for node, symbol in symbols.items()),
        relation.within,
        line.small,
        line.order,
    )


def _symbols_for_operators(sides: list[Any]) -> dict[sp.Expr, sp.Symbol]:
    """Return {derivative or integral: new symbol}. Operators within another one come after it."""
    nodes = {node for side in sides for node in side.atoms(sp.Derivative, sp.Integral)}
    names = {symbol.name for side in sides for symbol in side.free_symbols}
    symbols: dict[sp.Expr, sp.Symbol] = {}
    for node in sorted(nodes, key=lambda x: (-len(str(x)), str(x))):
        kind, count = node.func.__name__.lower(), len(symbols) + 1
        while f"{kind}_{count}" in names:
            count += 1
        names.add(f"{kind}_{count}")
        symbols[node] = sp.Symbol(f"{kind}_{count}", real=True)
    return symbols


def _unscaled(premise: Premise) -> Iterator[tuple[sp.Basic, Any]]:
    """Yield the equations of a premise. If it replaces a symbol F by epsilon*F, the F on the right becomes a new symbol."""
    scaled = {old: sp.Symbol(f"{old}_scaled", **old.assumptions0) for old in premise.put if old.is_Symbol}
    for old, new in premise.put.items():
        yield old, sp.sympify(new, strict=True).xreplace(scaled)


@dataclass(frozen=True)
class CertifiedLine:
    """One line of a certificate: the names of its theorems, or in `why_not` the reason why there are none."""

    name: str
    quantity: str
    verdict: str
    theorems: tuple[str, ...] = ()
    text: str = ""
    why_not: str = ""


def certificate(verdict: Verdict, entry: Equation) -> tuple[str, tuple[CertifiedLine, ...]]:
    """Return the text of an equation's file, and its lines; the text is empty if no line has a certificate."""
    lines = tuple(map(certified_line, propositions(verdict)))
    if not any(line.theorems for line in lines):
        return "", lines
    head = [f"{entry.id}: {entry.title}", f"as printed: {entry.latex}"]
    head += [f"as read: {entry.reading}"] if entry.reading else []
    body = (line.text or comment(f"{line.name}: {line.verdict}: no certificate: {line.why_not}") for line in lines)
    return "\n".join([*map(comment, head), "", PREAMBLE, *(f"{text}\n" for text in body)]), lines


def certified_line(proposition: Proposition) -> CertifiedLine:
    about = proposition.name, proposition.quantity, proposition.verdict
    try:
        theorems, text = _theorems(proposition)
    except NotExactError as refusal:
        return CertifiedLine(*about, why_not=str(refusal))
    return CertifiedLine(*about, theorems, text)


def _theorems(p: Proposition) -> Theorems:
    """Return the names of the theorems about one line of a verdict, and their text. Raises NotExactError if there are none."""
    if p.verdict not in ("holds", "holds-if", "holds-to-order", "refuted"):
        raise NotExactError(f"{p.verdict} is no exact verdict")
    if isinstance(p.printed, sp.MatrixBase) != isinstance(p.derived, sp.MatrixBase):
        return _kind_theorem(p)
    if p.verdict == "holds-to-order":
        return _order_theorem(p)
    if p.small is not None:
        return _refuted_order_theorem(p, p.order or 0)
    return _counterexamples(p) if p.verdict == "refuted" else _equality_theorem(p)


@dataclass(frozen=True)
class _Hypotheses:
    """The symbols and hypotheses of a theorem."""

    terms: Terms
    symbols: tuple[sp.Symbol, ...]
    functions: tuple[tuple[Any, int], ...]
    stands_for: tuple[tuple[sp.Symbol, sp.Expr], ...]
    signs: tuple[Comparison, ...]
    equations: tuple[tuple[str, sp.Expr, sp.Expr], ...]
    defined: tuple[Comparison, ...]

    @property
    def named(self) -> Iterator[tuple[str, str, str]]:
        """The hypotheses, each as (name, proposition, comment in words)."""
        for n, (sign, e) in enumerate(self.signs, 1):
            yield f"sign_{n}", comparison(self.terms, sign, e), ""
        for n, (says, lhs, rhs) in enumerate(self.equations, 1):
            yield f"premise_{n}", f"{self.terms.write(lhs)} = {self.terms.write(rhs)}", says
        for n, (sign, e) in enumerate(self.defined, 1):
            yield f"defined_{n}", comparison(self.terms, sign, e), ""

    @property
    def pairs(self) -> list[SymbolEquation]:
        return [(lhs, rhs) for _, lhs, rhs in self.equations]

    def binders(self) -> str:
        """Return the symbols and hypotheses as binders of a theorem."""
        comments: set[str] = set()
        rows = [f"({' '.join(self.terms.names[x] for x in self.symbols)} : R)"] if self.symbols else []
        for function, arity in self.functions:
            rows.append(f"  ({self.terms.names[function]} : {'R -> ' * arity}R)")
        rows += [f"  {comment(f'{symbol} stands for {node}')}" for symbol, node in self.stands_for]
        for name, text, words in self.named:
            rows.append(f"  ({name} : {text})" + (f" {comment(words)}" if words not in {"", *comments} else ""))
            comments.add(words)
        return "\n".join(rows)


def _hypotheses(p: Proposition, extra: Iterable[sp.Expr] = ()) -> _Hypotheses:
    sides = [*(e for pair in p.pairs for e in pair), *extra]
    region = tuple(map(_as_comparison, p.region))
    expressions = [*sides, *(e for _, lhs, rhs in p.equations for e in (lhs, rhs)), *(e for _, e in region)]
    for e in expressions:
        for node in sp.preorder_traversal(e):
            if node.is_Float or node in (sp.I, sp.oo, -sp.oo, sp.zoo, sp.nan):
                raise NotExactError(f"{node} is no real number that is exact")
    terms = Terms(expressions)
    symbols = tuple(sorted(set().union(*(e.free_symbols for e in expressions)), key=str))
    functions = sorted({(node.func, len(node.args)) for e in expressions for node in e.atoms(AppliedUndef)}, key=str)
    if len({function for function, _ in functions}) < len(functions):
        raise NotExactError("a function is called with different numbers of arguments")
    signs = tuple(declared_signs(symbols))
    conditions = (*conditions_of_value(expressions), *region)
    return _Hypotheses(terms, symbols, tuple(functions), p.stands_for, signs, p.equations, conditions)


def _as_comparison(condition: sp.Basic) -> Comparison:
    """Return an inequality of a premise as a comparison with zero. Raises NotExactError for another condition."""
    signs = {sp.Ne: "<>", sp.Ge: "<=", sp.Gt: "<", sp.Le: "<=", sp.Lt: "<"}
    if condition.func not in signs:
        raise NotExactError(f"the condition {condition} is no inequality")
    lhs, rhs = condition.args
    return signs[condition.func], rhs - lhs if condition.func in (sp.Le, sp.Lt) else lhs - rhs


def _equality_theorem(p: Proposition) -> Theorems:
    """Return the theorem that both sides are equal; if it has hypotheses, also the theorem that they hold somewhere."""
    h, sides = _prepare(p)
    pairs = list(p.pairs)
    if p.tolerance is not None:
        return _ratio_theorem(p, h, sides)
    tactics = [sides.equality(*pair) for pair in pairs]
    claims = [f"{h.terms.write(lhs)} = {h.terms.write(rhs)}" for lhs, rhs in pairs]
    return _theorem(p.name, f"{p.name}: {p.quantity}: {p.verdict}", h, sides, claims, tactics)


def _kind_theorem(p: Proposition) -> Theorems:
    """Return the theorem that a number is not a vector, for a line with a number on one side and a vector on the other."""
    sides = [list(side) if isinstance(side, sp.MatrixBase) else [side] for side in (p.printed, p.derived)]
    none = replace(p, printed=sp.S.Zero, derived=sp.S.Zero, equations=(), region=())
    h = _hypotheses(none, [e for side in sides for e in side])
    vector = " * ".join("R" for _ in max(sides, key=len))
    kinds = [f"{'inr' if len(side) > 1 else 'inl'} ({', '.join(map(h.terms.write, side))})" for side in sides]
    head = f"{p.name}: {p.quantity}: refuted: one side is a number, the other a vector"
    name = f"{p.name}_refuted"
    claim = f"{kinds[0]} <> ({kinds[1]} : R + ({vector}))%type"
    return (name,), f"{comment(head)}\nTheorem {name} {h.binders()} :\n  {claim}.\nProof.\n  discriminate.\nQed."


def _prepare(p: Proposition, extra: Iterable[sp.Expr] = ()) -> tuple["_Hypotheses", Sides]:
    """Return the hypotheses under which the sides and the `extra` expressions have values, and the sides in generators."""
    expressions = [*(e for pair in p.pairs for e in pair), *extra]
    h = _hypotheses(p, extra)
    return h, Sides(h.terms, expressions, h.pairs, h.defined, p.small)


def _ratio_theorem(p: Proposition, h: "_Hypotheses", sides: Sides) -> Theorems:
    """Return the theorem that a number read off a run is a constant times the derived one, and that this constant is near one.

    If the constant contains roots, both sides are nonnegative, and their squares have a rational ratio.
    """
    ratio = sp.cancel(sides.value(p.printed) / sides.value(p.derived))
    write, bound = h.terms.write, f"<= {h.terms.write(p.tolerance)}"
    if ratio.is_Rational:
        tactic = sides.equality(p.printed, ratio * p.derived)
        near = "apply Rabs_le; lra."
    else:
        draft = _prepare(p)[1]
        over, under = draft.in_generators(p.printed**2 / p.derived**2)
        square = sp.cancel((over / under).xreplace(draft.meaning()))
        if not (square.is_Rational and square > 0):
            raise NotExactError("the number read off a run, over what it should be, is no number")
        ratio = sp.sqrt(square)
        squares = (sp.Pow(side, 2, evaluate=False) for side in (p.printed, ratio * p.derived))  # as Coq has them
        same = in_one(sides.equality(*squares))
        above = in_one(f"{sides.substitution}first [assumption | lra | positive].")
        tactic = f"apply same_by_squares; [ {above} | {above} | {same} ]."
        near = "interval."
    claims = [f"{write(p.printed)} = {write(ratio * p.derived)}", f"Rabs ({write(ratio)} - 1) {bound}"]
    return _theorem(p.name, f"{p.name}: {p.quantity}: {p.verdict}", h, sides, claims, [tactic, near])


def _theorem(name: str, head: str, h: "_Hypotheses", sides: Sides, claims: list[str], tactics: list[str]) -> Theorems:
    """Return the theorem that the hypotheses imply the claims, and the theorem that the hypotheses hold somewhere."""
    proof = [*sides.steps, *(f"split. {{ {tactic} }}" for tactic in tactics[:-1]), tactics[-1]]
    claim, steps = " /\\\n  ".join(claims), "\n  ".join(proof)
    theorem = f"{comment(head)}\nTheorem {name} {h.binders()} :\n  {claim}.\nProof.\n  {steps}\nQed."
    if not (h.signs or h.equations or h.defined):
        return (name,), theorem
    return (name, f"{name}_has_a_case"), theorem + "\n" + _example_theorem(name, h, sides)


def _differences(p: Proposition, sides: Sides, small: sp.Symbol) -> list[tuple[sp.Expr, sp.Expr]]:
    """Return the pairs (a, b) for which a − b vanishes through the order.

    For a number read off a run, a is the ratio of this number to the derived one, and b is the limit of the ratio.
    """
    if p.tolerance is None:
        return list(p.pairs)
    inverse = sp.Pow(p.derived, -1, evaluate=False)
    ratio = sp.Mul(p.printed, inverse, evaluate=False)  # as printed, without cancellation
    return [(ratio, value_at_zero(sides, ratio, small))]


def _to_order(
    p: Proposition, small: sp.Symbol, order: int, pairs: Iterable[tuple[sp.Expr, sp.Expr]]
) -> tuple["_Hypotheses", Sides, list[str], list[str], list[SeriesRemainder]]:
    """Return claims and proofs that each pair differs by a power of the small quantity times a finite factor.

    The result is (hypotheses, sides, claims, tactics, remainders).
    """
    draft = _prepare(p, [e for pair in pairs for e in pair])[1]
    remainders = [remainder(draft, lhs - rhs, small, order) for lhs, rhs in pairs]
    h, sides = _prepare(p, [e for pair in pairs for e in pair] + [row.factor for row in remainders])
    write = h.terms.write
    rows = [*zip(pairs, remainders, strict=True)]
    claims = [f"{write(a)} - ({write(b)}) = {write(r.power)} * ({write(r.factor)})" for (a, b), r in rows]
    tactics = [sides.equality(a - b, r.power * r.factor) for (a, b), r in rows]
    for name, bound in _sines_over(small, remainders):
        claims.append(f"Rabs ({write(name)}) <= Rabs ({write(bound)})")
        tactics.append("apply sine_is_small.")
    return h, sides, claims, tactics, remainders


def _sines_over(small: sp.Symbol, remainders: list[SeriesRemainder]) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """Yield (sin x, x) for each sine that is divided by the small symbol; |sin x| ≤ |x| keeps the quotient finite."""
    for sine in sorted(set().union(*(r.factor.atoms(sp.sin) for r in remainders if r.at_zero is None)), key=str):
        if small in sine.free_symbols:
            yield sine, sine.args[0]


def _order_theorem(p: Proposition) -> Theorems:
    """Return the theorem that both sides differ by a power of the small quantity times a finite factor."""
    small, draft = p.small, _prepare(p)[1]
    assert small is not None
    pairs = _differences(p, draft, small)
    h, sides, claims, tactics, _ = _to_order(p, small, (p.order or 0) + 1, pairs)
    if p.tolerance is not None:
        claims.append(f"Rabs ({h.terms.write(pairs[0][1])} - 1) <= {h.terms.write(p.tolerance)}")
        tactics.append("interval.")
    head = f"{p.name}: {p.quantity}: {p.verdict}: through order {p.order} in {small}"
    return _theorem(p.name, head, h, sides, claims, tactics)


def _refuted_order_theorem(p: Proposition, order: int) -> Theorems:
    """Return two theorems: the sides differ by small**n times a finite factor, and this factor is not zero at a point."""
    small = p.small
    assert small is not None
    p = replace(p, equations=_consistent_choices(p.equations)[0])
    pair = _differences(p, _prepare(p)[1], small)[0]
    h, sides, claims, tactics, (remainder,) = _to_order(p, small, order + 1, [pair])
    if remainder.at_zero is None:
        raise NotExactError(f"the coefficient of order {order + 1} is a limit")
    write, name, where = h.terms.write, f"{p.name}_differs", f"{p.name}_refuted"
    head = f"{p.name}: {p.quantity}: refuted at order {order + 1} in {small}: how the sides differ, and a point where they do"
    _, text = _theorem(name, head, h, sides, claims, tactics)
    for point in points_of(h.symbols, sides.eliminated, [*h.signs, *h.defined], 24, zeros=[*sides.unsolved.values()]):
        value = value_at_point(remainder.at_zero, point)
        if value is not None and abs(value) > 1e-3:
            low, high = rational_bounds(value)
            rows = [proposition for _, proposition, _ in h.named]
            claim = " /\\ ".join([*rows, f"\n  {write(low)} <= {write(remainder.at_zero)} <= {write(high)}"])
            return (name, where), text + "\n" + _point_theorem(where, h, point, claim)
    raise NotExactError(f"no point was seen at which the coefficient of order {order + 1} is not zero")


def _example_theorem(name: str, h: _Hypotheses, sides: Sides) -> str:
    """Return the theorem that the hypotheses of a line hold together at some point."""
    _check_enclosed([e for _, e in (*h.signs, *h.defined)] + [e for pair in h.pairs for e in pair])
    near = [{sides.small: value} for value in (sp.S.Zero, sp.Rational(1, 100))] if sides.small else []  # for a series
    for fixed in (*near, {}):
        for point in points_of(
            h.symbols, sides.eliminated, [*h.signs, *h.defined], fixed=fixed, zeros=[*sides.unsolved.values()]
        ):
            claim = " /\\ ".join(text for _, text, _ in h.named)
            return _point_theorem(f"{name}_has_a_case", h, point, claim)
    raise NotExactError("no point was seen at which its hypotheses hold")


def _check_enclosed(expressions: Iterable[sp.Expr]) -> None:
    """Raise NotExactError if an expression has no enclosure at a rational point in Coq."""
    for e in expressions:
        if function := next(iter(e.atoms(AppliedUndef, sp.asin, sp.acos)), None):
            raise NotExactError(f"{function} has no enclosure at a point in Coq")
        if symbol := next((x for x in e.free_symbols if x.is_integer), None):
            raise NotExactError(f"{symbol} is a whole number, and points are rational")


def _point_theorem(name: str, h: _Hypotheses, point: dict[sp.Symbol, sp.Expr], claim: str) -> str:
    symbols = [h.terms.names[x] for x in h.symbols]
    values = ", ".join(f"({h.terms.write(point[x])})" for x in h.symbols)
    bound = f"exists {' '.join(symbols)} : R,\n  " if symbols else ""
    exists = f"exists {values}. " if symbols else ""
    return f"Theorem {name} : {bound}{claim}.\nProof. {exists}at_the_point. Qed."


def _counterexamples(p: Proposition) -> Theorems:
    """Return a counterexample for each largest set of premises that do not contradict each other."""
    choices = _consistent_choices(p.equations)
    names = [f"{p.name}_refuted" + (f"_{n}" if len(choices) > 1 else "") for n in range(1, len(choices) + 1)]
    head = comment(f"{p.name}: {p.quantity}: refuted: a point where the premises hold and the sides are apart")
    texts = [_counterexample(name, replace(p, equations=choice)) for name, choice in zip(names, choices, strict=True)]
    return tuple(names), "\n".join([head, *texts])


_Rows = tuple[tuple[str, sp.Expr, sp.Expr], ...]


def _consistent_choices(rows: _Rows) -> list[_Rows]:
    """Return the largest sets of premises that do not contradict each other, as rows with the text's values.

    Raises NotExactError for a premise that contradicts itself or cannot be solved.
    """
    premises = list(dict.fromkeys(says for says, _, _ in rows))
    for says in premises:
        elimination([(lhs, rhs) for name, lhs, rhs in rows if name == says])
    choices: dict[frozenset[str], _Rows] = {}
    for first in premises or [""]:
        chosen: set[str] = set()
        for says in (first, *premises):
            candidate = tuple(row for row in rows if row[0] in chosen | {says, SCENE})
            if _can_solve(candidate):
                chosen.add(says)
        choices[frozenset(chosen)] = tuple(row for row in rows if row[0] in chosen)
    return list(choices.values())


def _can_solve(rows: _Rows) -> bool:
    try:
        elimination([(lhs, rhs) for _, lhs, rhs in rows])
    except NotExactError:
        return False
    return True


def _counterexample(name: str, p: Proposition) -> str:
    """Return the theorem that the hypotheses hold and the sides differ at some point."""
    _check_enclosed([e for pair in (*p.pairs, *(row[1:] for row in p.equations)) for e in pair])
    if p.stands_for:
        raise NotExactError("a point says nothing of a derivative or an integral")
    h = _hypotheses(p)
    hold, (values, unsolved) = [*h.signs, *h.defined], elimination(h.pairs)
    pairs = [(lhs, rhs, lhs - rhs if p.tolerance is None else lhs / rhs - 1) for lhs, rhs in p.pairs]
    least = p.tolerance or sp.S.Zero
    best: tuple[Any, dict[sp.Symbol, sp.Expr], tuple[sp.Expr, ...]] | None = None
    for point in points_of(h.symbols, values, hold, 24, zeros=[*unsolved.values()]):
        for pair in pairs:
            value = value_at_point(pair[2], point)
            if value is not None and abs(value) > (best[0] if best else least):
                best = abs(value), point, pair
        if best is not None and best[0] > least + sp.Rational(1, 100):
            break
    if best is None:
        raise NotExactError("no point was seen at which its hypotheses hold and the sides differ")
    _, point, (lhs, rhs, difference) = best
    low, high = rational_bounds(value_at_point(difference, point))
    write = h.terms.write
    text = f"{write(lhs)} - ({write(rhs)})" if p.tolerance is None else f"({write(lhs)}) / ({write(rhs)}) - 1"
    rows = [proposition for _, proposition, _ in h.named]
    return _point_theorem(name, h, point, " /\\ ".join([*rows, f"\n  {write(low)} <= {text} <= {write(high)}"]))


def file_name(identifier: str) -> str:
    """Return the file name of an equation, a module name for Coq: equation_5_15.v."""
    return "equation_" + "".join(c if c.isascii() and c.isalnum() else "_" for c in identifier) + ".v"
