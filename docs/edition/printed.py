"""The equations of the paper as examples of the reader's edition: each printed line beside its derivation, as text.

A line is taken where the text, judged as a reader's would be, has the verdict that the audit gave the line.
"""

from collections.abc import Iterator

import sympy as sp

from lagrotor.errors import LagrotorError
from lagrotor.paper import Audit, LineVerdict, Paper, Premise, judge_text
from lagrotor.paper.verdicts import unconnected

LONGEST = 900  # characters of an equation that is still read in a form


def examples_of(paper: Paper, audit: Audit) -> Iterator[dict[str, str]]:
    """The fields of the form, one a printed line."""
    for verdict in audit:
        entry = paper.equation(verdict.id)
        several = len(verdict.lines) > 1
        for number, line in enumerate(verdict.lines, 1):
            if fields := example_of(line, line_premises(line, verdict.statement.premises)):
                title = f"{verdict.id}{f', line {number}' * several}: {entry.title}"
                about = f"Recorded: {line.verdict}. Left as printed, right as derived."
                yield fields | {"title": title, "about": about, "group": f"Section {entry.section} of the paper"}


def line_premises(line: LineVerdict, offered: tuple[Premise, ...]) -> list[sp.Basic]:
    """What may be assumed of a line, as relations."""
    whole = (*offered, *line.relation.scene_premises)
    idle = unconnected((line.relation.printed, line.relation.derived), whole)
    assumed = [premise for premise in whole if premise not in idle]
    equations = [sp.Eq(a, b, evaluate=False) for premise in assumed if not premise.small for a, b in premise.equations]
    return [*equations, *(relation for premise in assumed for relation in premise.conditions)]


def example_of(line: LineVerdict, premises: list[sp.Basic]) -> dict[str, str] | None:
    """The fields for one line; None where it is no expression that a form can hold, or is judged otherwise from text."""
    left, right = line.relation.printed, line.relation.derived
    if line.relation.within is not None or not all(isinstance(side, sp.Expr) for side in (left, right)):
        return None
    if not left.free_symbols | right.free_symbols or str(left) == str(right):
        return None
    letters = set().union(left.free_symbols, right.free_symbols, *(each.free_symbols for each in premises))
    fields = {
        "equation": f"{left} = {right}",
        "given": "\n".join(f"{each.lhs} {each.rel_op.replace('==', '=')} {each.rhs}" for each in premises),
        "positive": " ".join(sorted(s.name for s in letters if s.is_positive)),
        "small": str(line.relation.small or line.small or ""),
        "order": str(line.relation.claimed or line.order or ""),
    }
    if len(fields["equation"]) > LONGEST or not all(s.is_real and s.name.isidentifier() for s in letters):
        return None
    try:
        order = int(fields["order"] or 0)
        said = judge_text(
            fields["equation"], fields["given"].splitlines(), fields["positive"].split(), fields["small"], order
        )
    except LagrotorError:
        return None
    return fields if said.verdict.verdict == line.verdict else None
