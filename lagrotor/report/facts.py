"""The sentences of a report: facts about equations, claims and figures, counts of verdicts, and the main results."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from string import Formatter
from typing import Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper import catalogue
from lagrotor.paper.audit import dimension_texts, line_text
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import AGREES, Verdict, point_tex, point_text
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import Report, word
from lagrotor.report.errata import correction_lines, premise_formulas


@dataclass(frozen=True)
class Fact:
    """A labelled line below an equation, a claim or a figure.

    texts: sentences. ids: what the line links to. formulas: expressions; a single symbol completes the sentence before it.
    sources: formulas in LaTeX.
    """

    label: str
    texts: tuple[str, ...] = ()
    ids: tuple[str, ...] = ()
    formulas: tuple[sp.Basic, ...] = ()
    sources: tuple[str, ...] = ()


def facts(verdict: Verdict, report: Report) -> Iterator[Fact]:
    """Yield the facts about a verdict, which the report shows below the printed and the derived formula."""
    statement = verdict.statement
    is_refuted = verdict.verdict == "refuted"
    if verdict.refuted_under:
        yield _condition("Premises of the error", verdict.refuted_under)
    if verdict.premises:
        yield _condition("Premises of the correction" if is_refuted else "Condition", verdict.premises)
    if verdict.order is not None and verdict.small is not None:
        agree = f"the printed and the derived expression agree through order {verdict.order} in"
        yield Fact("Order", (agree,), formulas=(verdict.small,))
    if verdict.domain:
        yield Fact("Domain", ("both sides are defined and real only where",), formulas=verdict.domain)
    if sentences := dimension_texts(verdict):
        yield Fact("Dimensions", tuple(f"{text}." for text in sentences))
    evidence = verdict.evidence
    if any(line.verdict in ("refuted", "undecided") for line in verdict.lines):
        points = tuple(filter(None, map(point_tex, verdict.lines)))
        sentences = tuple(dict.fromkeys(f"{line_text(line)}." for line in verdict.lines))
        yield Fact("Lines", sentences, sources=points)
        evidence = tuple(item for item in evidence if not any(item in line for line in sentences))
    if statement.correction:
        answer = word(verdict.correction_verdict or "undecided")
        answer = f"the verdict on the corrected equation, by the same procedure, is: {answer}"
        yield Fact("Correction", (answer,), sources=correction_lines(verdict))
    if verdict.reaches_result is not None:
        yield Fact("Effect on results", (_EFFECTS[verdict.reaches_result],))
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
    return Fact(label, ("; ".join(dict.fromkeys(p.sentence for p in premises)),), sources=premise_formulas(premises))


_EFFECTS = {True: "this error changes a result of the paper", False: "no result of the paper depends on this error"}


def linked_facts(result: Result, report: Report) -> Iterator[Fact]:
    """Yield the theorems that decide parts of a claim, and the equations and figures that it concerns."""
    for claim_part, theorem in result.finding.theorems:
        yield Fact("Proved", (f"{claim_part.says}: {claim_part.outcome}.", theorem.text))
    entry, judged = report.paper.claims[result.test.id], {verdict.id for verdict in report.verdicts}
    drawn = {picture.key for picture in report.pictures}
    if ids := tuple(i for i in entry.equations if i in judged):
        yield Fact("Equations", ids=ids)
    if ids := tuple(f"figure {number}" for number in entry.figures if number in drawn):
        yield Fact("Figures", ids=ids)


def figure_facts(picture: Picture, report: Report) -> Iterator[Fact]:
    """Yield the equations and claims to which a figure of the paper belongs."""
    entry = report.paper.figures.get(int(picture.key)) if picture.key.isdigit() else None
    judged = {verdict.id for verdict in report.verdicts}
    if entry and (ids := tuple(i for i in entry.equations if i in judged)):
        yield Fact("Equations", ids=ids)
    if ids := tuple(r.test.id for r in report.claims if picture.key in report.paper.claims[r.test.id].figures):
        yield Fact("Claims", ids=ids)


def note(verdict: Verdict) -> str:
    """Return the text for the column "Reason or condition" of a table of verdicts.

    It is the error of a refuted equation, the evidence on an undecided one, otherwise order and conditions; "" if none.
    """
    if verdict.verdict == "refuted":
        points = (point_text(line) for line in verdict.lines if line.verdict == "refuted")
        return verdict.statement.wrong or next(filter(None, points), "")
    if verdict.verdict == "undecided" and verdict.evidence:
        return verdict.evidence[0].partition(";")[0]
    clauses = list(dict.fromkeys(premise.says for premise in verdict.premises))
    if verdict.order is not None and verdict.small is not None:
        clauses.insert(0, f"the two sides agree through order {verdict.order} in {verdict.small}")
    broken = any(premise.broken for premise in verdict.premises)
    return "; ".join(clauses) + (". The paper's own scene does not satisfy this." if broken else "")


_FIELD = re.compile(r"([^\[\]]+)(?:\[(.+)\])?")


@dataclass(frozen=True)
class Headline:
    """A main result of the paper: its title, a sentence with numbers, and the ids that it links to.

    formula: LaTeX, "" without one. figure: such as "figure 19", "" without one.
    """

    title: str
    text: str
    ids: tuple[str, ...]
    formula: str = ""
    figure: str = ""


def opening(report: Report) -> list[tuple[str, str]]:
    """Return the label and the sentence of each opening line of `paper.toml`, with the numbers filled in."""
    numbers = _Numbers(report)
    return [(line.label, numbers.format(line.text)) for line in report.paper.about.opening]


def balance(report: Report) -> str:
    """Return the sentences that count the equations with each verdict, and the refuted equations with a correction."""
    if not report.verdicts:
        return f"None of {len(report.waiting)} equations is judged yet."
    counts = report.counts
    ways = {"holds": "exactly", "holds-if": "under a stated condition", "holds-to-order": "to a stated order"}
    hold = {answer: counts[answer] for answer in ways if answer in counts}
    refuted = [verdict for verdict in report.verdicts if verdict.verdict == "refuted"]
    corrected = sum(v.correction_verdict in ways for v in refuted)
    reaching = sum(bool(v.reaches_result) for v in refuted)
    undecided, waiting = counts.get("undecided", 0), len(report.waiting)
    remainder = len(report.verdicts) - sum(hold.values()) - len(refuted) - undecided
    text = f"{sum(hold.values())} of {len(report.verdicts)} equations hold"
    text += f": {', '.join(f'{n} {ways[answer]}' for answer, n in hold.items())}. " if hold else ". "
    if refuted:
        text += f"{len(refuted)} {'is' if len(refuted) == 1 else 'are'} refuted"
        if corrected == len(refuted):
            text += ", each with a correction that holds"
        elif corrected:
            text += f"; a correction that holds is given for {corrected} of these"
        text += f"; results of the paper are affected by {reaching or 'none'} of these errors."
    else:
        text += "None is refuted."
    text += f" {undecided} {'is' if undecided == 1 else 'are'} undecided." if undecided else ""
    kind = "is a definition or a measured number" if remainder == 1 else "are definitions or measured numbers"
    text += f" {remainder} {kind}." if remainder else ""
    return text + (f" {waiting} more {'is' if waiting == 1 else 'are'} not yet judged." if waiting else "")


def unmet(report: Report) -> str:
    """Return sentences on the premises that the paper's own scene does not meet, "" if it meets all of them.

    They count the equations that hold under such premises, and name the three premises that most of these need.
    """
    needed = [tuple(p.says for p in v.premises if p.broken) for v in report.verdicts if v.verdict in AGREES]
    holding, affected = len(needed), [premises for premises in needed if premises]
    frequent = Counter(says for premises in affected for says in dict.fromkeys(premises)).most_common()
    if not affected:
        return ""
    first = [says for says, _ in frequent[:3]]
    named = "; ".join(f"{says} ({count} equations)" for says, count in frequent[:3])
    some = sum(any(says in first for says in premises) for premises in affected)
    return (
        f"Of the {holding} equations that hold, {len(affected)} need a premise that the paper's own scene does not meet. "
        f"There are {len(frequent)} such premises. The three that most equations need are: {named}; "
        f"{some} of the {len(affected)} equations need at least one of these. The verdicts on these {len(affected)} do not "
        "extend to the paper's own scene, for which the equations are at best approximate. Each entry says how far the "
        "scene is from the premise."
    )


def headlines(report: Report) -> list[Headline]:
    """Return those headlines of `paper.toml` whose equations, claims and figures are all in the report."""
    numbers = _Numbers(report)
    return [numbers.headline(entry) for entry in report.paper.about.headline if numbers.has(entry)]


class _Numbers(Formatter):
    """The formatter that fills numbers and verdicts into the sentences of `paper.toml`.

    Fields are {C02[rate]:.3f}, {figure 3[period (s)]:.2f}, {2.1} (a verdict), {2.1[correction]} and {refuted} (a count).
    """

    def __init__(self, report: Report) -> None:
        self.verdicts = {verdict.id: verdict for verdict in report.verdicts}
        self.measured: dict[str, Mapping[str, float]] = {r.test.id: r.measured for r in report.claims}
        hold = ("holds", "holds-if", "holds-to-order")
        self.counts = {
            "equations": len(report.verdicts),
            "claims": len(report.claims),
            "holding": sum(report.counts.get(answer, 0) for answer in hold),
            "refuted": report.counts.get("refuted", 0),
        }
        self.measured |= {f"figure {picture.key}": picture.measured for picture in report.pictures}

    def has(self, entry: catalogue.HeadlineEntry) -> bool:
        """Return True if the report has every number, verdict and formula that a headline names."""
        fields = (match for _, name, _, _ in self.parse(entry.text) if (match := _FIELD.fullmatch(name or "")))
        needed = {match[1] for match in fields} | ({entry.formula} if entry.formula else set())
        return needed <= self.verdicts.keys() | self.measured.keys()

    def headline(self, entry: catalogue.HeadlineEntry) -> Headline:
        identifiers = self.verdicts.keys() | self.measured.keys()
        ids = tuple(identifier for identifier in entry.ids if identifier in identifiers)
        return Headline(entry.title, self.format(entry.text), ids, self._formula(entry), entry.figure)

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        """Return the value of a field, and the id in it. Raises InputError for an unknown id or number."""
        if field_name in self.counts:
            return self.counts[field_name], field_name
        match = _FIELD.fullmatch(field_name)
        identifier, name = (match[1], match[2] or "") if match else (field_name, "")
        if identifier in self.verdicts:
            verdict = self.verdicts[identifier]
            answer = verdict.correction_verdict if name == "correction" else verdict.verdict
            return word(answer or "undecided"), identifier
        if identifier not in self.measured:
            helps = "write the id of one, such as 2.1, C02 or figure 3"
            raise InputError(f"paper.toml: {{{field_name}}} is no equation, claim or figure of the report: {helps}")
        measured = self.measured[identifier]
        if name not in measured:
            helps = f"write one of {', '.join(measured)}"
            raise InputError(f"paper.toml: headline: {identifier} does not measure {name!r}: {helps}")
        return measured[name], identifier

    def _formula(self, entry: catalogue.HeadlineEntry) -> str:
        """Return the corrected line of a headline's equation in LaTeX, else the derived one; "" if it names no equation."""
        if not entry.formula:
            return ""
        statement = self.verdicts[entry.formula].statement
        corrected = [(r.quantity, r.written or latex(r.printed)) for r in statement.correction]
        derived = [(r.quantity, r.written or latex(r.derived)) for r in statement.relations]
        for quantity, line in corrected or derived:
            if entry.quantity in ("", quantity):
                return f"{quantity} = {line}"
        helps = f"write one of {', '.join(quantity for quantity, _ in corrected or derived)}"
        raise InputError(f"paper.toml: headline: {entry.formula} has no quantity {entry.quantity!r}: {helps}")
