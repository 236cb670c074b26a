"""What the reader's edition answers: a Lagrangian or an equation as text in, a piece of HTML out. It runs in the browser."""

from collections.abc import Iterator
from html import escape
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_zero
from lagrotor.errors import InputError, LagrotorError
from lagrotor.mechanics import System, constrained_accelerations, coordinates, momenta, t
from lagrotor.mechanics.glossary import latex
from lagrotor.paper import LineVerdict, judge_text
from lagrotor.paper.grammar import read
from lagrotor.paper.judgement import letters_in
from lagrotor.paper.plain_text import readable
from lagrotor.paper.verdicts import AGREES, point_text
from lagrotor.report.formulas.mathml_latex import mathml

LONGEST = 400  # operations of an expression that is shown


def answer(kind: str, **fields: str) -> str:
    """The answer of one of the two forms, or in words what cannot be read."""
    try:
        return "".join(system(**fields) if kind == "system" else judged(**fields))
    except LagrotorError as error:
        return f'<p class="refusal">{escape(str(error))}</p>'


def system(c: str, L: str, constraints: str, positive: str, integral: str, at: str) -> Iterator[str]:
    """Equations of motion, integrals, cyclic coordinates; whether an expression is conserved; small motion about a point."""
    names = coordinates(" ".join(c.replace(",", " ").split()))
    moving = {s.name: s for row in (names.q, names.v, names.a) for s in row} | {"t": t}
    bonds = [line.split("=")[0].strip() if line.rstrip().endswith("= 0") else line for line in lines(constraints)]
    points = [part.partition("=")[::2] for part in at.split(",") if part.strip()]
    texts = [L, *bonds, *filter(None, [integral]), *(value for _, value in points)]
    letters = letters_in(texts, names_of(positive)) | moving
    made = System(names, read(L, letters, "L"), constraints=tuple(read(line, letters, "constraint") for line in bonds))
    yield heading("Lagrangian") + formula("L", made.L)
    yield heading("Equations of motion")
    yield from (formula("", equation, "= 0") for equation in made.motion)
    if made.constraints:
        yield note("λ are the forces of the constraints.")
    accelerations, forces = constrained_accelerations(made)
    solved = [*zip(names.a, accelerations, strict=True), *zip(made.multipliers, forces, strict=True)]
    yield heading("Solved for the accelerations")
    yield from (formula(latex(left), sp.factor(right)) for left, right in solved)
    yield heading("What is conserved")
    cyclic = made.cyclic
    for q, p in zip(names.q, momenta(made.L, names), strict=True):
        if q in cyclic:
            yield note(f"{readable(q.name)} is cyclic; its momentum is conserved:") + formula(f"p_{{{latex(q)}}}", p)
    power = made.power
    kept = decide_zero(power).answer == "zero"
    yield note("The energy is conserved:" if kept else "The energy is not conserved:") + formula("E", made.energy)
    yield "" if kept else formula(r"\frac{dE}{dt}", power)
    if integral:
        value = read(integral, letters, "integral")
        decision = made.conserved(value)
        says = {"zero": "is conserved", "nonzero": "is not conserved", "undecided": "is undecided"}[decision.answer]
        yield heading("Your integral") + formula("f", value) + note(f"It {says}. {decision.reason}")
    if at:
        point = {read(q.strip(), letters, "at"): read(value, letters, "at") for q, value in points}
        small = made.linearise({q: point.get(q, sp.S.Zero) for q in (*names.q, *names.v)} | point)
        yield heading("Small motion there")
        yield from (formula(r"\lambda", rate) for rate in dict.fromkeys(mode.rate for mode in small.modes()))
        yield note("e to the λ t: an imaginary λ = iω is an oscillation.") + formula(
            "", small.stable_if, "", "stable if "
        )


def judged(equation: str, given: str, positive: str, small: str, order: str) -> Iterator[str]:
    """The verdict on an equation with domain and premises, or the point at which it fails."""
    if small and not order.strip().isdigit():
        raise InputError(f"order: {order!r} is no whole number: through which order in {small} is it claimed?")
    said = judge_text(equation, lines(given), names_of(positive), small.strip(), int(order) if small else 0)
    verdict = said.verdict
    yield heading("As it was read") + "".join(f"<p><code>{escape(text)}</code></p>" for text in said.readings)
    through = f" through order {verdict.order} in {readable(str(verdict.small))}"
    yield f'<p class="verdict {verdict.verdict}">{verdict.verdict}{through * (verdict.verdict == "holds-to-order")}</p>'
    if assumed := verdict.premises or verdict.refuted_under:
        yield heading("Under these premises" + ", the fewest that suffice" * bool(verdict.premises))
        yield from (formula("", tex) for premise in assumed for tex in premise.tex or (premise.says,))
    if verdict.verdict in AGREES and verdict.domain:
        yield heading("Where both sides are defined and real")
        yield from (formula("", relation) for relation in verdict.domain)
    for line in verdict.lines:
        if line.verdict not in AGREES:
            yield from shortfall(line)
    yield "".join(formula(latex(line.relation.printed), line.relation.derived) for line in verdict.lines)


def shortfall(line: LineVerdict) -> Iterator[str]:
    """Why a line does not hold: in words, the difference, and a point with its certified value."""
    if line.reason:
        yield note(line.reason)
    if line.difference is not None:
        yield heading("Left less right") + formula("", line.difference)
    if seen := point_text(line, ("left", "right")):
        yield heading("Witness") + note(seen)
        exact = ", ".join(f"{readable(str(s))} = {value}" for s, value in (line.witness or {}).items())
        yield note(f"exactly: {exact}; the value is enclosed in rational numbers of one sign.")


def lines(text: str) -> list[str]:
    """The lines of a text that are not empty."""
    return [line.strip() for line in text.splitlines() if line.strip()]


def names_of(text: str) -> list[str]:
    """Names between blanks or commas."""
    return text.replace(",", " ").split()


def heading(text: str) -> str:
    """A heading of the answer."""
    return f"<h3>{escape(text)}</h3>"


def note(text: str) -> str:
    """A line of words."""
    return f"<p>{escape(readable(text))}</p>"


def formula(left: str, value: Any, right: str = "", before: str = "") -> str:
    """`left = value right`, typeset; what is too long to be read is said to be so."""
    if isinstance(value, sp.Basic) and sp.count_ops(value) > LONGEST:
        return note(f"{readable(left)}: an expression of {sp.count_ops(value)} operations")
    source = f"{left} = " * bool(left) + (value if isinstance(value, str) else latex(value)) + right
    return f'<div class="formula" tabindex="0">{escape(before)}{mathml(source) or escape(source)}</div>'
