"""What the report begins with: the balance of the verdicts, and the results that `paper.toml` puts first, with their numbers."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from string import Formatter
from typing import Any

from lagrotor.errors import InputError
from lagrotor.mechanics.glossary import latex
from lagrotor.paper import catalogue
from lagrotor.report.content import Report, word

_FIELD = re.compile(r"([^\[\]]+)(?:\[(.+)\])?")


@dataclass(frozen=True)
class Headline:
    """One result: what it says in a line, the sentence with its numbers, a formula in LaTeX, where it is shown, its figure."""

    title: str
    text: str
    ids: tuple[str, ...]
    formula: str = ""
    figure: str = ""


def opening(report: Report) -> list[tuple[str, str]]:
    """The lines that the report opens with: (label, sentence)."""
    numbers = _Numbers(report)
    return [(line.label, numbers.format(line.text)) for line in report.paper.about.opening]


def balance(report: Report) -> str:
    """How many equations hold and how many are refuted, and what becomes of those."""
    if not report.verdicts:
        return f"No equation is judged yet, of {len(report.waiting)}."
    counts = report.counts
    ways = {
        "holds": "exactly",
        "holds-if": "under a condition that is named",
        "holds-to-order": "to the order that is named",
    }
    hold = {answer: counts[answer] for answer in ways if answer in counts}
    fallen = [verdict for verdict in report.verdicts if verdict.verdict == "refuted"]
    corrected = sum(v.correction_verdict in ways for v in fallen)
    reaching = sum(bool(v.reaches_result) for v in fallen)
    undecided, waiting = counts.get("undecided", 0), len(report.waiting)
    other = len(report.verdicts) - sum(hold.values()) - len(fallen) - undecided
    text = f"Of {len(report.verdicts)} equations {sum(hold.values())} hold"
    text += f": {', '.join(f'{n} {ways[answer]}' for answer, n in hold.items())}. " if hold else ". "
    if fallen:
        text += f"{len(fallen)} {'is' if len(fallen) == 1 else 'are'} refuted"
        if corrected == len(fallen):
            text += ", each with a correction that itself holds"
        elif corrected:
            text += f"; for {corrected} of these a correction is given that itself holds"
        text += f"; results of the paper depend on {reaching or 'none'} of them."
    else:
        text += "None is refuted."
    text += f" {undecided} {'is' if undecided == 1 else 'are'} undecided." if undecided else ""
    text += f" The other {other} give a name or a measured number." if other else ""
    return text + (f" {waiting} more {'is' if waiting == 1 else 'are'} not yet judged." if waiting else "")


def headlines(report: Report) -> list[Headline]:
    """The results that the paper puts first, those whose equations, claims and figures are in the report."""
    numbers = _Numbers(report)
    return [numbers.headline(each) for each in report.paper.about.headline if numbers.has(each)]


class _Numbers(Formatter):
    """Fills in what is in braces: {C02[rate]:.3f}, {figure 3[period (s)]:.2f}, {2.1}, {2.1[correction]}."""

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

    def has(self, given: catalogue.HeadlineEntry) -> bool:
        """Whether all that the headline takes its numbers and its formula from is in the report."""
        fields = (match for _, name, _, _ in self.parse(given.text) if (match := _FIELD.fullmatch(name or "")))
        needed = {match[1] for match in fields} | ({given.formula} if given.formula else set())
        return needed <= self.verdicts.keys() | self.measured.keys()

    def headline(self, given: catalogue.HeadlineEntry) -> Headline:
        """The headline with its numbers."""
        known = self.verdicts.keys() | self.measured.keys()
        ids = tuple(identifier for identifier in given.ids if identifier in known)
        return Headline(given.title, self.format(given.text), ids, self._formula(given), given.figure)

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        """The value of what is in braces. Raises InputError for a number that a test does not measure."""
        if field_name in self.counts:
            return self.counts[field_name], field_name
        match = _FIELD.fullmatch(field_name)
        identifier, name = (match[1], match[2] or "") if match else (field_name, "")
        if identifier in self.verdicts:
            verdict = self.verdicts[identifier]
            answer = verdict.correction_verdict if name == "correction" else verdict.verdict
            return word(answer or "undecided"), identifier
        if identifier not in self.measured:
            raise InputError(f"paper.toml: {{{field_name}}} is no equation, claim or figure of the report")
        measured = self.measured[identifier]
        if name not in measured:
            raise InputError(f"paper.toml: headline: {identifier} does not measure {name!r}: {', '.join(measured)}")
        return measured[name], identifier

    def _formula(self, given: catalogue.HeadlineEntry) -> str:
        """The corrected, or else the derived form of an equation, of the named quantity or the first."""
        if not given.formula:
            return ""
        statement = self.verdicts[given.formula].statement
        corrected = [(r.quantity, r.written or latex(r.printed)) for r in statement.correction]
        derived = [(r.quantity, r.written or latex(r.derived)) for r in statement.relations]
        for quantity, line in corrected or derived:
            if given.quantity in ("", quantity):
                return f"{quantity} = {line}"
        raise InputError(f"paper.toml: headline: {given.formula} has no quantity {given.quantity!r}")
