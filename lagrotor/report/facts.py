"""What the report says of a verdict, a claim and a figure besides formulas: labelled lines."""

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from lagrotor.paper.audit import dimension_texts, line_text
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import Verdict, point_tex, point_text
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import Report, word
from lagrotor.report.errata import correction_lines, premise_formulas


@dataclass(frozen=True)
class Fact:
    """One labelled line: sentences, ids of what it leads to, formulas; a lone symbol ends the text; formulas in LaTeX."""

    label: str
    texts: tuple[str, ...] = ()
    ids: tuple[str, ...] = ()
    formulas: tuple[sp.Basic, ...] = ()
    sources: tuple[str, ...] = ()


def facts(verdict: Verdict, report: Report) -> Iterator[Fact]:
    """What is said of a verdict besides the two formulas; only what applies."""
    statement = verdict.statement
    is_refuted = verdict.verdict == "refuted"
    if verdict.refuted_under:
        yield _condition("Error as stated if", verdict.refuted_under)
    if verdict.premises:
        yield _condition("Correction holds if" if is_refuted else "Condition", verdict.premises)
    if verdict.order is not None and verdict.small is not None:
        yield Fact("Order", (f"agrees through order {verdict.order} in",), formulas=(verdict.small,))
    if verdict.domain:
        yield Fact("Domain", formulas=verdict.domain)
    if said := dimension_texts(verdict):
        yield Fact("Dimensions", tuple(f"{text}." for text in said))
    evidence = verdict.evidence
    if any(line.verdict in ("refuted", "undecided") for line in verdict.lines):
        points = tuple(filter(None, map(point_tex, verdict.lines)))
        said = tuple(dict.fromkeys(f"{line_text(line)}." for line in verdict.lines))
        yield Fact("Lines", said, sources=points)
        evidence = tuple(each for each in evidence if not any(each in line for line in said))
    if statement.correction:
        answer = f"judged by the same rules: {word(verdict.correction_verdict or 'undecided')}"
        yield Fact("Correction", (answer,), sources=correction_lines(verdict))
    if verdict.reaches_result is not None:
        yield Fact("Reaches the result", (_REACHES[verdict.reaches_result],))
    for theorem in verdict.theorems:
        yield Fact("Proved", (theorem.text,))
    if evidence:
        yield Fact("Evidence", evidence)
    linked = {
        "Uses": statement.depends_on,
        "Used by": report.users(verdict.id),
        "Claims": report.claims_about(verdict.id),
        "Figures": report.figures_of(verdict.id),
    }
    for label, ids in linked.items():
        if ids:
            yield Fact(label, ids=ids)


def _condition(label: str, premises: tuple[Premise, ...]) -> Fact:
    return Fact(label, ("; ".join(p.sentence for p in premises),), sources=premise_formulas(premises))


_REACHES = {
    True: "yes: a result of the paper that depends on it is refuted too",
    False: "no: no result of the paper depends on this error",
}


def linked_facts(result: Result, report: Report) -> Iterator[Fact]:
    """The theorems that decide parts of a claim; the equations and figures it is about, as far as they are in the report."""
    for part, theorem in result.finding.theorems:
        yield Fact("Proved", (f"{part.says}: {part.outcome}.", theorem.text))
    entry, judged = report.paper.claims[result.test.id], {verdict.id for verdict in report.verdicts}
    drawn = {picture.key for picture in report.pictures}
    if ids := tuple(i for i in entry.equations if i in judged):
        yield Fact("Equations", ids=ids)
    if ids := tuple(f"figure {number}" for number in entry.figures if number in drawn):
        yield Fact("Figures", ids=ids)


def figure_facts(picture: Picture, report: Report) -> Iterator[Fact]:
    """The equations and claims that a figure of the paper belongs to, as far as they are in the report."""
    entry = report.paper.figures.get(int(picture.key)) if picture.key.isdigit() else None
    judged = {verdict.id for verdict in report.verdicts}
    if entry and (ids := tuple(i for i in entry.equations if i in judged)):
        yield Fact("Equations", ids=ids)
    if ids := tuple(r.test.id for r in report.claims if picture.key in report.paper.claims[r.test.id].figures):
        yield Fact("Claims", ids=ids)


def note(verdict: Verdict) -> str:
    """What a table says beside the verdict's word: why it is refuted or undecided, or the order and the condition in short."""
    if verdict.verdict == "refuted":
        points = (point_text(line) for line in verdict.lines if line.verdict == "refuted")
        return verdict.statement.wrong or next(filter(None, points), "")
    if verdict.verdict == "undecided" and verdict.evidence:
        return verdict.evidence[0].partition(";")[0]
    parts = list(dict.fromkeys(premise.says for premise in verdict.premises))
    if verdict.order is not None and verdict.small is not None:
        parts.insert(0, f"agrees through order {verdict.order} in {verdict.small}")
    broken = any(premise.broken for premise in verdict.premises)
    return "; ".join(parts) + (". The paper's own scene does not meet this." if broken else "")
