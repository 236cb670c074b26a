"""One certificate: the file of Coq that states what was decided of an equation's lines, and proves it.

Each line is a theorem over the reals. Its letters are variables; what they were declared as, the premises and the conditions
under which both sides have a value are hypotheses; it ends in printed = derived, or, of a refuted line, in a point at which
all hypotheses hold and the two differ by an enclosure without zero. A line that holds has a second theorem, that its
hypotheses hold at some point: contradictory ones would prove anything.

The printed side is the catalogue's, the other what was derived, both without any premise put in; premises and the values of a
scene are equations beside them. A letter that a premise scales, such as F in F = epsilon*F, is another one on the right.
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
from lagrotor.proofs.coq.cofactors import LetterEquation, elimination
from lagrotor.proofs.coq.coq_terms import (
    Comparison,
    Terms,
    comment,
    comparison,
    conditions_of_value,
    declared_signs,
)
from lagrotor.proofs.coq.equality_steps import Sides, in_one
from lagrotor.proofs.coq.points import points_of, rational_bounds, value_at_point
from lagrotor.proofs.coq.remainders import SeriesRest, remainder, value_at_zero

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


# What the values that the text gives for a line are called among its premises.
SCENE = "the text's values"


@dataclass(frozen=True)
class Proposition:
    """One line of an equation, or of its correction, as it was line.

    name: that of its theorem, line_1 or correction_1. equations: the premises' and the scene's, (left, right) with the words
    for each; they are what the line holds under, or, of a refuted one, all that were offered. region: their inequalities.
    stands_for: a letter for each derivative and integral, of which nothing is used but that it is the same wherever it stands.
    small, order: of a series.
    """

    name: str
    quantity: str
    verdict: Answer
    printed: Any
    derived: Any
    equations: tuple[tuple[str, sp.Expr, sp.Expr], ...] = ()
    region: tuple[sp.Basic, ...] = ()
    stands_for: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    within: sp.Rational | None = None
    small: sp.Symbol | None = None
    order: int | None = None

    @property
    def pairs(self) -> tuple[tuple[sp.Expr, sp.Expr], ...]:
        """(printed, derived), entry by entry."""
        if isinstance(self.printed, sp.MatrixBase) and isinstance(self.derived, sp.MatrixBase):
            return tuple(zip(self.printed, self.derived, strict=True))
        return ((self.printed, self.derived),)


def propositions(verdict: Verdict) -> Iterator[Proposition]:
    """Every printed line of an equation, then every line of its correction."""
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
        if premise.small is None or old not in set_otherwise  # a letter that is zero need not be small
    ]
    where = [each for premise in premises for each in premise.where]
    rows += [(str(each), each.lhs, each.rhs) for each in where if isinstance(each, sp.Eq)]
    rows += [(SCENE, old, new) for old, new in relation.scene.items()]
    rows = [(says, sp.sympify(old, strict=True), sp.sympify(new, strict=True)) for says, old, new in rows]
    held = [relation.printed, relation.derived, *where, *(side for _, *sides in rows for side in sides)]
    letters = _letters_for_operators(held)
    return Proposition(
        name,
        relation.quantity,
        line.verdict,
        relation.printed.xreplace(letters),
        relation.derived.xreplace(letters),
        tuple((says, old.xreplace(letters), new.xreplace(letters)) for says, old, new in rows),
        tuple(each.xreplace(letters) for each in where if not isinstance(each, sp.Eq)),
        tuple((letter, node) for node, letter in letters.items()),
        relation.within,
        line.small,
        line.order,
    )


def _letters_for_operators(held: list[Any]) -> dict[sp.Expr, sp.Symbol]:
    """Derivative or integral -> a letter that no side holds; those that hold others first."""
    nodes = {node for side in held for node in side.atoms(sp.Derivative, sp.Integral)}
    names = {symbol.name for side in held for symbol in side.free_symbols}
    found: dict[sp.Expr, sp.Symbol] = {}
    for node in sorted(nodes, key=lambda each: (-len(str(each)), str(each))):
        kind, count = node.func.__name__.lower(), len(found) + 1
        while f"{kind}_{count}" in names:
            count += 1
        names.add(f"{kind}_{count}")
        found[node] = sp.Symbol(f"{kind}_{count}", real=True)
    return found


def _unscaled(premise: Premise) -> Iterator[tuple[sp.Basic, Any]]:
    """The rows of a premise; a letter that it replaces is another one where it stands on the right."""
    scaled = {old: sp.Symbol(f"{old}_scaled", **old.assumptions0) for old in premise.put if old.is_Symbol}
    for old, new in premise.put.items():
        yield old, sp.sympify(new, strict=True).xreplace(scaled)


@dataclass(frozen=True)
class CertifiedLine:
    """One line of a certificate. theorems: the names that Coq is to accept; why_not: why there is none."""

    name: str
    quantity: str
    verdict: str
    theorems: tuple[str, ...] = ()
    text: str = ""
    why_not: str = ""


def certificate(verdict: Verdict, entry: Equation) -> tuple[str, tuple[CertifiedLine, ...]]:
    """The file of one equation, and its lines; the text is empty where no line has a certificate."""
    lines = tuple(map(certified_line, propositions(verdict)))
    if not any(line.theorems for line in lines):
        return "", lines
    head = [f"{entry.id}: {entry.title}", f"as printed: {entry.latex}"]
    head += [f"as read: {entry.reading}"] if entry.reading else []
    body = (line.text or comment(f"{line.name}: {line.verdict}: no certificate: {line.why_not}") for line in lines)
    return "\n".join([*map(comment, head), "", PREAMBLE, *(f"{text}\n" for text in body)]), lines


def certified_line(proposition: Proposition) -> CertifiedLine:
    """One line with its theorems, or with why it has none."""
    about = proposition.name, proposition.quantity, proposition.verdict
    try:
        theorems, text = _theorems(proposition)
    except NotExactError as refusal:
        return CertifiedLine(*about, why_not=str(refusal))
    return CertifiedLine(*about, theorems, text)


def _theorems(p: Proposition) -> tuple[tuple[str, ...], str]:
    """The names of the theorems of one line, and their text. Raises NotExactError where there is none."""
    if p.verdict not in ("holds", "holds-if", "holds-to-order", "refuted"):
        raise NotExactError(f"{p.verdict} is no exact verdict")
    if isinstance(p.printed, sp.MatrixBase) != isinstance(p.derived, sp.MatrixBase):
        return _of_another_kind(p)
    if p.verdict == "holds-to-order":
        return _held_to_order(p)
    if p.small is not None:
        return _refuted_at_order(p, p.order or 0)
    return _refuted(p) if p.verdict == "refuted" else _held(p)


@dataclass(frozen=True)
class _Hypotheses:
    """What a theorem assumes, beside its letters."""

    terms: Terms
    letters: tuple[sp.Symbol, ...]
    functions: tuple[tuple[Any, int], ...]
    stands_for: tuple[tuple[sp.Symbol, sp.Expr], ...]
    signs: tuple[Comparison, ...]
    equations: tuple[tuple[str, sp.Expr, sp.Expr], ...]
    defined: tuple[Comparison, ...]

    @property
    def named(self) -> Iterator[tuple[str, str, str]]:
        """(name, proposition, words)."""
        for n, (sign, e) in enumerate(self.signs, 1):
            yield f"sign_{n}", comparison(self.terms, sign, e), ""
        for n, (says, left, right) in enumerate(self.equations, 1):
            yield f"premise_{n}", f"{self.terms.write(left)} = {self.terms.write(right)}", says
        for n, (sign, e) in enumerate(self.defined, 1):
            yield f"defined_{n}", comparison(self.terms, sign, e), ""

    @property
    def pairs(self) -> list[LetterEquation]:
        """The premises' equations."""
        return [(left, right) for _, left, right in self.equations]

    def binders(self) -> str:
        """The letters and hypotheses as binders of a theorem."""
        said: set[str] = set()
        rows = [f"({' '.join(self.terms.names[x] for x in self.letters)} : R)"] if self.letters else []
        for function, arity in self.functions:
            rows.append(f"  ({self.terms.names[function]} : {'R -> ' * arity}R)")
        rows += [f"  {comment(f'{letter} stands for {node}')}" for letter, node in self.stands_for]
        for name, text, words in self.named:
            rows.append(f"  ({name} : {text})" + (f" {comment(words)}" if words not in {"", *said} else ""))
            said.add(words)
        return "\n".join(rows)


def _hypotheses(p: Proposition, more: Iterable[sp.Expr] = ()) -> _Hypotheses:
    sides = [*(e for pair in p.pairs for e in pair), *more]
    region = tuple(map(_as_comparison, p.region))
    held = [*sides, *(e for _, left, right in p.equations for e in (left, right)), *(e for _, e in region)]
    for e in held:
        for node in sp.preorder_traversal(e):
            if node.is_Float or node in (sp.I, sp.oo, -sp.oo, sp.zoo, sp.nan):
                raise NotExactError(f"{node} is no real number that is exact")
    terms = Terms(held)
    letters = tuple(sorted(set().union(*(e.free_symbols for e in held)), key=str))
    functions = sorted({(node.func, len(node.args)) for e in held for node in e.atoms(AppliedUndef)}, key=str)
    if len({function for function, _ in functions}) < len(functions):
        raise NotExactError("a function is called with different numbers of arguments")
    signs = tuple(declared_signs(letters))
    return _Hypotheses(
        terms, letters, tuple(functions), p.stands_for, signs, p.equations, (*conditions_of_value(held), *region)
    )


def _as_comparison(condition: sp.Basic) -> Comparison:
    """An inequality of a premise as a comparison with zero. Raises NotExactError for another condition."""
    signs = {sp.Ne: "<>", sp.Ge: "<=", sp.Gt: "<", sp.Le: "<=", sp.Lt: "<"}
    if condition.func not in signs:
        raise NotExactError(f"the condition {condition} is no inequality")
    left, right = condition.args
    return signs[condition.func], right - left if condition.func in (sp.Le, sp.Lt) else left - right


def _held(p: Proposition) -> tuple[tuple[str, ...], str]:
    """The theorem that both sides are equal, and, where it has hypotheses, that they hold somewhere."""
    h, sides = _prepared(p)
    pairs = list(p.pairs)
    if p.within is not None:
        return _read_off(p, h, sides)
    tactics = [sides.equality(*pair) for pair in pairs]
    claims = [f"{h.terms.write(left)} = {h.terms.write(right)}" for left, right in pairs]
    return _theorem(p.name, f"{p.name}: {p.quantity}: {p.verdict}", h, sides, claims, tactics)


def _of_another_kind(p: Proposition) -> tuple[tuple[str, ...], str]:
    """The theorem that a number is no vector: quantities are numbers or vectors, and the sides are one of each."""
    sides = [list(side) if isinstance(side, sp.MatrixBase) else [side] for side in (p.printed, p.derived)]
    none = replace(p, printed=sp.S.Zero, derived=sp.S.Zero, equations=(), region=())
    h = _hypotheses(none, [e for side in sides for e in side])
    vector = " * ".join("R" for _ in max(sides, key=len))
    kinds = [f"{'inr' if len(side) > 1 else 'inl'} ({', '.join(map(h.terms.write, side))})" for side in sides]
    head = f"{p.name}: {p.quantity}: refuted: one side is a number, the other a vector"
    name = f"{p.name}_refuted"
    claim = f"{kinds[0]} <> ({kinds[1]} : R + ({vector}))%type"
    return (name,), f"{comment(head)}\nTheorem {name} {h.binders()} :\n  {claim}.\nProof.\n  discriminate.\nQed."


def _prepared(p: Proposition, more: Iterable[sp.Expr] = ()) -> tuple["_Hypotheses", Sides]:
    """What a theorem about a line assumes, where further expressions have a value too, and both sides in generators."""
    expressions = [*(e for pair in p.pairs for e in pair), *more]
    h = _hypotheses(p, more)
    return h, Sides(h.terms, expressions, h.pairs, h.defined, p.small)


def _read_off(p: Proposition, h: "_Hypotheses", sides: Sides) -> tuple[tuple[str, ...], str]:
    """The theorem that a number read off a run is a constant times the derived one, and that this is near one.

    Where the constant holds roots, neither side is negative, and their squares are a rational number times each other.
    """
    ratio = sp.cancel(sides.value(p.printed) / sides.value(p.derived))
    write, within = h.terms.write, f"<= {h.terms.write(p.within)}"
    if ratio.is_Rational:
        tactic = sides.equality(p.printed, ratio * p.derived)
        near = "apply Rabs_le; lra."
    else:
        draft = _prepared(p)[1]
        over, under = draft.in_generators(p.printed**2 / p.derived**2)
        square = sp.cancel((over / under).xreplace(draft.meaning()))
        if not (square.is_Rational and square > 0):
            raise NotExactError("the number read off a run, over what it should be, is no number")
        ratio = sp.sqrt(square)
        squares = (sp.Pow(side, 2, evaluate=False) for side in (p.printed, ratio * p.derived))  # as Coq has them
        same = in_one(sides.equality(*squares))
        above = in_one(f"{sides.put_in}first [assumption | lra | positive].")
        tactic = f"apply same_by_squares; [ {above} | {above} | {same} ]."
        near = "interval."
    claims = [f"{write(p.printed)} = {write(ratio * p.derived)}", f"Rabs ({write(ratio)} - 1) {within}"]
    return _theorem(p.name, f"{p.name}: {p.quantity}: {p.verdict}", h, sides, claims, [tactic, near])


def _theorem(
    name: str, head: str, h: "_Hypotheses", sides: Sides, claims: list[str], tactics: list[str]
) -> tuple[tuple[str, ...], str]:
    """The theorem that the claims follow from the hypotheses, and, where there are any, that these hold somewhere."""
    proof = [*sides.steps, *(f"split. {{ {each} }}" for each in tactics[:-1]), tactics[-1]]
    claim, steps = " /\\\n  ".join(claims), "\n  ".join(proof)
    theorem = f"{comment(head)}\nTheorem {name} {h.binders()} :\n  {claim}.\nProof.\n  {steps}\nQed."
    if not (h.signs or h.equations or h.defined):
        return (name,), theorem
    return (name, f"{name}_has_a_case"), theorem + "\n" + _satisfied(name, h, sides)


def _differences(p: Proposition, sides: Sides, small: sp.Symbol) -> list[tuple[sp.Expr, sp.Expr]]:
    """Pairs whose difference is to vanish through the order: the sides; of a number read off a run their ratio and its start."""
    if p.within is None:
        return list(p.pairs)
    inverse = sp.Pow(p.derived, -1, evaluate=False)
    ratio = sp.Mul(p.printed, inverse, evaluate=False)  # as it is printed, nothing cancelled
    return [(ratio, value_at_zero(sides, ratio, small))]


def _to_order(
    p: Proposition, small: sp.Symbol, order: int, pairs: Iterable[tuple[sp.Expr, sp.Expr]]
) -> tuple["_Hypotheses", Sides, list[str], list[str], list[SeriesRest]]:
    """Claims that pairs differ by a power of the small quantity times what is finite there, and how they are proved."""
    draft = _prepared(p, [e for pair in pairs for e in pair])[1]
    rests = [remainder(draft, left - right, small, order) for left, right in pairs]
    h, sides = _prepared(p, [e for pair in pairs for e in pair] + [each.rest for each in rests])
    write = h.terms.write
    claims = [
        f"{write(a)} - ({write(b)}) = {write(r.power)} * ({write(r.rest)})"
        for (a, b), r in zip(pairs, rests, strict=True)
    ]
    tactics = [sides.equality(a - b, r.power * r.rest) for (a, b), r in zip(pairs, rests, strict=True)]
    for name, bound in _sines_over(small, rests):
        claims.append(f"Rabs ({write(name)}) <= Rabs ({write(bound)})")
        tactics.append("apply sine_is_small.")
    return h, sides, claims, tactics, rests


def _sines_over(small: sp.Symbol, rests: list[SeriesRest]) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """Sines that stand over the small letter: each is at most its angle, so that the quotient stays finite."""
    for sine in sorted(set().union(*(r.rest.atoms(sp.sin) for r in rests if r.at_zero is None)), key=str):
        if small in sine.free_symbols:
            yield sine, sine.args[0]


def _held_to_order(p: Proposition) -> tuple[tuple[str, ...], str]:
    """The theorem that the two sides differ by a power of the small quantity times what stays finite."""
    small, draft = p.small, _prepared(p)[1]
    assert small is not None
    pairs = _differences(p, draft, small)
    h, sides, claims, tactics, _ = _to_order(p, small, (p.order or 0) + 1, pairs)
    if p.within is not None:
        claims.append(f"Rabs ({h.terms.write(pairs[0][1])} - 1) <= {h.terms.write(p.within)}")
        tactics.append("interval.")
    head = f"{p.name}: {p.quantity}: {p.verdict}: through order {p.order} in {small}"
    return _theorem(p.name, head, h, sides, claims, tactics)


def _refuted_at_order(p: Proposition, order: int) -> tuple[tuple[str, ...], str]:
    """The two sides differ by small**n times what is finite at zero; and at some point it is not zero there."""
    small = p.small
    assert small is not None
    p = replace(p, equations=_consistent(p.equations)[0])
    pair = _differences(p, _prepared(p)[1], small)[0]
    h, sides, claims, tactics, (rest,) = _to_order(p, small, order + 1, [pair])
    if rest.at_zero is None:
        raise NotExactError(f"the coefficient of order {order + 1} is a limit")
    write, name, where = h.terms.write, f"{p.name}_differs", f"{p.name}_refuted"
    head = f"{p.name}: {p.quantity}: refuted at order {order + 1} in {small}: how the sides differ, and a point where they do"
    _, text = _theorem(name, head, h, sides, claims, tactics)
    for point in points_of(h.letters, sides.eliminated, [*h.signs, *h.defined], 24, zeros=[*sides.unsolved.values()]):
        value = value_at_point(rest.at_zero, point)
        if value is not None and abs(value) > 1e-3:
            low, high = rational_bounds(value)
            rows = [proposition for _, proposition, _ in h.named]
            claim = " /\\ ".join([*rows, f"\n  {write(low)} <= {write(rest.at_zero)} <= {write(high)}"])
            return (name, where), text + "\n" + _at(where, h, point, claim)
    raise NotExactError(f"no point was seen at which the coefficient of order {order + 1} is not zero")


def _satisfied(name: str, h: _Hypotheses, sides: Sides) -> str:
    """The theorem that the hypotheses of a line hold together at some point."""
    _check_enclosed([e for _, e in (*h.signs, *h.defined)] + [e for pair in h.pairs for e in pair])
    near = [{sides.small: value} for value in (sp.S.Zero, sp.Rational(1, 100))] if sides.small else []  # of a series
    for fixed in (*near, {}):
        for point in points_of(
            h.letters, sides.eliminated, [*h.signs, *h.defined], fixed=fixed, zeros=[*sides.unsolved.values()]
        ):
            claim = " /\\ ".join(text for _, text, _ in h.named)
            return _at(f"{name}_has_a_case", h, point, claim)
    raise NotExactError("no point was seen at which its hypotheses hold")


def _check_enclosed(expressions: Iterable[sp.Expr]) -> None:
    """Raise NotExactError where an expression has no enclosure at a rational point in Coq."""
    for e in expressions:
        if found := next(iter(e.atoms(AppliedUndef, sp.asin, sp.acos)), None):
            raise NotExactError(f"{found} has no enclosure at a point in Coq")
        if letter := next((x for x in e.free_symbols if x.is_integer), None):
            raise NotExactError(f"{letter} is a whole number, and points are rational")


def _at(name: str, h: _Hypotheses, point: dict[sp.Symbol, sp.Expr], claim: str) -> str:
    letters = [h.terms.names[x] for x in h.letters]
    values = ", ".join(f"({h.terms.write(point[x])})" for x in h.letters)
    bound = f"exists {' '.join(letters)} : R,\n  " if letters else ""
    exists = f"exists {values}. " if letters else ""
    return f"Theorem {name} : {bound}{claim}.\nProof. {exists}at_the_point. Qed."


def _refuted(p: Proposition) -> tuple[tuple[str, ...], str]:
    """A point for each choice of premises that do not contradict each other, with as many of them as there can be."""
    choices = _consistent(p.equations)
    names = [f"{p.name}_refuted" + (f"_{n}" if len(choices) > 1 else "") for n in range(1, len(choices) + 1)]
    head = comment(f"{p.name}: {p.quantity}: refuted: a point where the premises hold and the sides are apart")
    texts = [_apart(name, replace(p, equations=choice)) for name, choice in zip(names, choices, strict=True)]
    return tuple(names), "\n".join([head, *texts])


_Rows = tuple[tuple[str, sp.Expr, sp.Expr], ...]


def _consistent(rows: _Rows) -> list[_Rows]:
    """The largest choices of premises, all rows of each, that can be solved together; the text's values are in each.

    Raises NotExactError for a premise that contradicts itself or is not solved.
    """
    premises = list(dict.fromkeys(says for says, _, _ in rows))
    for says in premises:
        elimination([(left, right) for name, left, right in rows if name == says])
    found: dict[frozenset[str], _Rows] = {}
    for first in premises or [""]:
        chosen: set[str] = set()
        for says in (first, *premises):
            tried = tuple(row for row in rows if row[0] in chosen | {says, SCENE})
            if _solved(tried):
                chosen.add(says)
        found[frozenset(chosen)] = tuple(row for row in rows if row[0] in chosen)
    return list(found.values())


def _solved(rows: _Rows) -> bool:
    try:
        elimination([(left, right) for _, left, right in rows])
    except NotExactError:
        return False
    return True


def _apart(name: str, p: Proposition) -> str:
    """The theorem that there is a point at which the hypotheses hold and the two sides differ."""
    _check_enclosed([e for pair in (*p.pairs, *(row[1:] for row in p.equations)) for e in pair])
    if p.stands_for:
        raise NotExactError("a point says nothing of a derivative or an integral")
    h = _hypotheses(p)
    hold, (values, unsolved) = [*h.signs, *h.defined], elimination(h.pairs)
    pairs = [(left, right, left - right if p.within is None else left / right - 1) for left, right in p.pairs]
    least = p.within or sp.S.Zero
    best: tuple[Any, dict[sp.Symbol, sp.Expr], tuple[sp.Expr, ...]] | None = None
    for point in points_of(h.letters, values, hold, 24, zeros=[*unsolved.values()]):
        for pair in pairs:
            value = value_at_point(pair[2], point)
            if value is not None and abs(value) > (best[0] if best else least):
                best = abs(value), point, pair
        if best is not None and best[0] > least + sp.Rational(1, 100):
            break
    if best is None:
        raise NotExactError("no point was seen at which its hypotheses hold and the sides differ")
    _, point, (left, right, difference) = best
    low, high = rational_bounds(value_at_point(difference, point))
    write = h.terms.write
    text = f"{write(left)} - ({write(right)})" if p.within is None else f"({write(left)}) / ({write(right)}) - 1"
    rows = [proposition for _, proposition, _ in h.named]
    return _at(name, h, point, " /\\ ".join([*rows, f"\n  {write(low)} <= {text} <= {write(high)}"]))


def file_name(identifier: str) -> str:
    """The name of an equation's file, a module's name for Coq: equation_5_15.v."""
    return "equation_" + "".join(c if c.isascii() and c.isalnum() else "_" for c in identifier) + ".v"
