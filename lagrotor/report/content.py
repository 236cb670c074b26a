"""What a report says, before it is put into HTML or Markdown."""

import platform
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version

import sympy as sp

from ..paper.catalogue import Equation, equation, equations
from ..paper.ledger import Relation, Verdict
from ..paper.tables import Table
from ..paper.trials import Result
from .figures import Picture, past

TITLE = "Dynamics of Axially Coupled Rotor Pairs"
SUBTITLE = "Every equation as printed and as derived, with its verdict"

MEANINGS = {
    "holds": "the printed and the derived expression are the same, decided exactly",
    "holds-if": "they are the same under the condition that is named",
    "holds-to-order": "they agree up to and including the order that is named",
    "refuted": "they differ; the correction, where there is one, is judged by the same rules",
    "measured": "a number read off a run, beside what it should have been",
    "definition": "the line only gives a name",
    "confirmed": "a claim that its own run bears out",
    "confirmed-if": "a claim that holds under the condition that is named",
    "undecided": "outside what can be decided exactly; numbers are given as evidence",
}


@dataclass(frozen=True)
class Report:
    """All that one run found. `changes`: verdicts that differ from the recorded ones, a sentence each.

    claims: the paper's claims after their trials; findings: (title, sentence) of what the derivations found besides;
    tables: runs side by side; past: tables of what holds beyond the paper, and theory: its findings.
    """

    verdicts: tuple[Verdict, ...]
    pictures: tuple[Picture, ...]
    changes: tuple[str, ...]
    seconds: float
    claims: tuple[Result, ...] = ()
    findings: tuple[tuple[str, str], ...] = ()
    tables: tuple[Table, ...] = ()
    past: tuple[Table, ...] = ()
    theory: tuple[tuple[str, str], ...] = ()

    @property
    def papers_pictures(self) -> list[Picture]:
        """The paper's figures."""
        return [picture for picture in self.pictures if not past(picture.key)]

    @property
    def past_pictures(self) -> list[Picture]:
        """The figures of the theory past the paper."""
        return [picture for picture in self.pictures if past(picture.key)]

    @property
    def waiting(self) -> list[Equation]:
        """Equations of the paper that no derivation states yet."""
        judged = {verdict.id for verdict in self.verdicts}
        return [entry for entry in equations().values() if entry.id not in judged]

    @property
    def sections(self) -> dict[str, list[Verdict]]:
        """Verdicts by section of the paper."""
        found: dict[str, list[Verdict]] = {}
        for verdict in self.verdicts:
            found.setdefault(equation(verdict.id).section, []).append(verdict)
        return found

    @property
    def counts(self) -> dict[str, int]:
        """How many equations have each verdict, in the order of `MEANINGS`, those with none left out."""
        counted: Counter[str] = Counter(verdict.verdict for verdict in self.verdicts)
        return {answer: counted[answer] for answer in MEANINGS if counted[answer]}

    def users(self, identifier: str) -> tuple[str, ...]:
        """Ids of the equations that use this one."""
        return tuple(v.id for v in self.verdicts if identifier in v.statement.depends_on)


@dataclass(frozen=True)
class Fact:
    """One labelled line under an equation: sentences, ids of other equations, formulas; a lone symbol ends the text."""

    label: str
    texts: tuple[str, ...] = ()
    ids: tuple[str, ...] = ()
    formulas: tuple[sp.Basic, ...] = ()


def versions() -> dict[str, str]:
    """What the run was made with."""
    return {"Python": platform.python_version()} | {name: version(name) for name in ("sympy", "numpy", "scipy")}


def word(answer: str) -> str:
    """A verdict as people read it."""
    return answer.replace("-", " ")


def sides(relations: tuple[Relation, ...], side: str) -> tuple[sp.Basic, ...]:
    """The printed or derived expressions of some relations, each once."""
    return tuple(dict.fromkeys(getattr(relation, side) for relation in relations))


def facts(verdict: Verdict, report: Report) -> Iterator[Fact]:
    """What is said of a verdict besides the two formulas; only what applies."""
    statement = verdict.statement
    if verdict.condition:
        yield Fact("Condition", (verdict.condition,))
    if verdict.order is not None and verdict.small is not None:
        yield Fact("Order", (f"agrees through order {verdict.order} in",), formulas=(verdict.small,))
    if verdict.domain:
        yield Fact("Domain", formulas=tuple(sp.Ne(factor, 0, evaluate=False) for factor in verdict.domain))
    if statement.correction:
        answer = f"judged by the same rules: {word(verdict.correction_verdict or 'undecided')}"
        yield Fact("Correction", (answer,), formulas=sides(statement.correction, "printed"))
    if verdict.reaches_result is not None:
        yield Fact("Reaches the result", (_REACHES[verdict.reaches_result],))
    if statement.depends_on:
        yield Fact("Uses", ids=statement.depends_on)
    if users := report.users(verdict.id):
        yield Fact("Used by", ids=users)
    if verdict.evidence:
        yield Fact("Evidence", verdict.evidence)
    yield Fact("Time", (f"{verdict.seconds:.2f} s",))


_REACHES = {
    True: "yes: a result of the paper that rests on it is refuted too",
    False: "no: every result of the paper that rests on it stands",
}


def note(verdict: Verdict) -> str:
    """What a table says beside the verdict's word: the order or the condition."""
    if verdict.order is not None and verdict.small is not None:
        order = f"agrees through order {verdict.order} in {verdict.small}"
        return f"{order}; {verdict.condition}" if verdict.condition else order
    return verdict.condition or ""
