"""The report as Markdown with LaTeX between dollar signs, as code hosts draw it."""

import re
from collections.abc import Iterable

import sympy as sp

from ..paper.catalogue import claims, equation
from ..paper.ledger import Verdict
from ..paper.tables import Cell, FigureLink, Table
from ..paper.trials import Result
from ..symbols import latex
from .content import MEANINGS, SUBTITLE, TITLE, Fact, Report, facts, note, sides, versions, word
from .errata import errata
from .figures import Picture


def markdown(report: Report) -> str:
    """The whole report; figures are linked as `figures/<stem>.svg`."""
    blocks = [f"# {TITLE}", f"{SUBTITLE}.", _summary(report), _table(report)]
    for section, verdicts in report.sections.items():
        blocks.append(f"## Section {section}")
        blocks += [_equation(verdict, report) for verdict in verdicts]
    blocks += errata_blocks(report.verdicts)
    if report.claims:
        blocks.append("## Claims")
        blocks += [_claim(result) for result in report.claims]
    if report.findings:
        blocks.append("## Findings")
        blocks += [f"**{_prose(title)}.** {_prose(text)}" for title, text in report.findings]
    for table in report.tables:
        blocks += _side_by_side(table)
    if report.papers_pictures:
        blocks.append("## Figures")
        blocks += [_picture(picture) for picture in report.papers_pictures]
    if report.past or report.theory or report.past_pictures:
        blocks.append("## Past the paper")
        for table in report.past:
            blocks += _side_by_side(table, "###")
        blocks += [f"**{_prose(title)}.** {_prose(text)}" for title, text in report.theory]
        blocks += [_picture(picture) for picture in report.past_pictures]
    if report.waiting:
        rows = [(entry.id, _prose(entry.title)) for entry in report.waiting]
        blocks += ["## Not yet judged", _rows(("Equation", "Title"), rows)]
    made = ", ".join(f"{name} {number}" for name, number in versions().items())
    blocks += ["## How this was made", f"{made}; {report.seconds:.1f} s in all."]
    return "\n\n".join(blocks) + "\n"


def _summary(report: Report) -> str:
    lines = [f"- {word(answer)}: {count} ({MEANINGS[answer]})" for answer, count in report.counts.items()]
    lines.append(f"- not yet judged: {len(report.waiting)}")
    if report.changes:
        lines += ["", "**Changed against the record:**", "", *(f"- {_prose(change)}" for change in report.changes)]
    return "\n".join(lines)


def _table(report: Report) -> str:
    rows = [
        (f"[{v.id}](#{_anchor(v.id)})", _prose(equation(v.id).title), word(v.verdict), _prose(note(v)))
        for v in report.verdicts
    ]
    return _rows(("Equation", "Title", "Verdict", "Order or condition"), rows)


def _equation(verdict: Verdict, report: Report) -> str:
    entry, statement = equation(verdict.id), verdict.statement
    parts = [
        f'<a id="{_anchor(verdict.id)}"></a>',
        f"### {verdict.id} {_prose(entry.title)}: {word(verdict.verdict)}",
        "As printed:",
        _display(entry.latex),
    ]
    if derived := sides(statement.relations, "derived"):
        parts += ["As derived:", *map(_formula, derived)]
    parts += [_fact(fact) for fact in facts(verdict, report)]
    if statement.steps:
        parts += ["Steps:", "\n".join(f"{i}. {_prose(step)}" for i, step in enumerate(statement.steps, 1))]
    return "\n\n".join(parts)


def _fact(fact: Fact) -> str:
    words = [_prose(text) for text in fact.texts] + [", ".join(f"[{i}](#{_anchor(i)})" for i in fact.ids)]
    words += [f"${latex(letter)}$" for letter in fact.formulas if letter.is_Symbol]
    line = f"**{fact.label}:** " + " ".join(filter(None, words))
    return "\n\n".join([line.rstrip(), *(_formula(formula) for formula in fact.formulas if not formula.is_Symbol)])


def errata_blocks(verdicts: Iterable[Verdict]) -> list[str]:
    """The errata sheet as Markdown blocks; none when nothing is refuted."""
    blocks = []
    for e in errata(verdicts):
        used = ", ".join(f"[{i}](#{_anchor(i)})" for i in e.used_by) or "none"
        blocks += [
            f"### Erratum {e.id} {_prose(e.title)}",
            _prose(e.wrong),
            "Printed:",
            _display(e.printed),
            f"Correct ({e.verdict_of_correction}):",
            *map(_display, e.corrected),
            f"Used by: {used}; {e.reach}.",
        ]
    return ["## Errata", *blocks] if blocks else []


def _claim(result: Result) -> str:
    entry, finding = claims()[result.trial.id], result.finding
    parts = [f"### {entry.id}: {word(finding.outcome)}", f"> {_prose(entry.text)}", _prose(finding.explanation)]
    if finding.condition:
        parts.append(f"**If:** {_prose(finding.condition)}")
    rows = [(_prose(name.replace("_", " ")), f"{value:.6g}") for name, value in result.measured.items()]
    return "\n\n".join([*parts, _rows((f"Measured ({_prose(result.trial.model)})", "Value"), rows)])


def _side_by_side(table: Table, level: str = "##") -> list[str]:
    rows = [tuple(_cell(cell) for cell in row) for row in table.rows]
    return [f"{level} {_prose(table.title)}", _rows(table.head, rows), _prose(table.note)]


def _cell(cell: Cell) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_cell, cell))
    if isinstance(cell, FigureLink):
        return f"[figure {cell.key}](#figure-{cell.key})"
    return f"${latex(cell)}$" if isinstance(cell, sp.Basic) else _prose(cell)


def _picture(picture: Picture) -> str:
    image = f"![{_prose(picture.alt)}](figures/{picture.svg.name})"
    heading = f'<a id="figure-{picture.key}"></a>\n\n### Figure {picture.key}: {_prose(picture.title)}'
    parts = [heading, image, _prose(picture.caption)]
    if picture.measured:
        parts.append(_rows(("Measured", "Value"), [(_prose(n), f"{v:.6g}") for n, v in picture.measured.items()]))
    return "\n\n".join(parts)


def _rows(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _formula(expression: sp.Basic) -> str:
    return _display(latex(expression))


def _display(source: str) -> str:
    return f"$$\n{source}\n$$"


def _anchor(identifier: str) -> str:
    return f"eq-{identifier}"


def _prose(text: str) -> str:
    """Text on one line in which nothing is read as Markdown, HTML or a table's edge."""
    return re.sub(r"([\\`*_\[\]<>|#$~])", r"\\\1", " ".join(text.split()))
