"""The report as one HTML page that needs nothing else: style, formulas and figures are inside it."""

from base64 import b64encode
from collections import Counter
from collections.abc import Iterable
from html import escape
from pathlib import Path

import sympy as sp

from ..paper.catalogue import claims, equation
from ..paper.ledger import Statement, Verdict
from ..paper.tables import Cell, FigureLink, Table
from ..paper.trials import Result
from .content import MEANINGS, SUBTITLE, TITLE, Fact, Report, facts, note, sides, versions, word
from .errata import Erratum, errata
from .figures import Picture
from .mathml import mathml

_STYLE = Path(__file__).with_name("page.css")
# A picture larger than this as SVG goes in as PNG: two dozen of them stay under 5 MB.
_LARGEST_SVG = 150_000
# Characters of MathML beyond which the derived form stands below the printed one, not beside it.
_WIDEST = 1_200


def page(report: Report) -> str:
    """The whole report."""
    sections = [(f"section-{name}", f"Section {name}", verdicts) for name, verdicts in report.sections.items()]
    links = [(anchor, heading) for anchor, heading, _ in sections]
    sheet = list(errata(report.verdicts))
    links += [("errata", "Errata")] * bool(sheet)
    links += [("claims", "Claims")] * bool(report.claims)
    links += [("findings", "Findings")] * bool(report.findings)
    links += [("tables", "Tables")] * bool(report.tables)
    links += [("figures", "Figures")] * bool(report.papers_pictures)
    beyond = _past(report)
    links += [("past", "Past the paper")] * bool(beyond)
    links += [("waiting", "Not yet judged")] * bool(report.waiting)
    links.append(("made", "How this was made"))
    body = [
        f"<header><h1>{escape(TITLE)}</h1><p>{escape(SUBTITLE)}.</p></header>",
        "<nav>" + " ".join(f'<a href="#{anchor}">{escape(heading)}</a>' for anchor, heading in links) + "</nav>",
        _summary(report),
        _table(report),
    ]
    for anchor, heading, verdicts in sections:
        body.append(f'<h2 id="{anchor}">{escape(heading)}</h2>')
        body += [_equation(verdict, report) for verdict in verdicts]
    if sheet:
        stated = {v.id: v.statement for v in report.verdicts}
        body += ['<h2 id="errata">Errata</h2>', *(_erratum(e, stated[e.id]) for e in sheet)]
    if report.claims:
        body.append('<h2 id="claims">Claims</h2>')
        body += [_claim(result) for result in report.claims]
    if report.findings:
        body.append('<h2 id="findings">Findings</h2>')
        body += [f"<h3>{escape(title)}</h3><p>{escape(text)}</p>" for title, text in report.findings]
    if report.tables:
        body.append('<h2 id="tables">Tables</h2>')
        body += [_side_by_side(table, report) for table in report.tables]
    if report.papers_pictures:
        body.append('<h2 id="figures">Figures</h2>')
        body += [_picture(picture) for picture in report.papers_pictures]
    if beyond:
        body += ['<h2 id="past">Past the paper</h2>', *beyond]
    if report.waiting:
        rows = [(entry.id, escape(entry.title)) for entry in report.waiting]
        body += ['<h2 id="waiting">Not yet judged</h2>', _rows(("Equation", "Title"), rows)]
    body += ['<h2 id="made">How this was made</h2>', _made(report)]
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta name="color-scheme" content="light dark">',
            f"<title>{escape(TITLE)}: {escape(SUBTITLE.lower())}</title>",
            f"<style>\n{_STYLE.read_text(encoding='utf-8')}</style></head>",
            "<body><main>",
            *body,
            "</main></body></html>\n",
        ]
    )


def _summary(report: Report) -> str:
    items = [
        f"<li><b>{count}</b> {_badge(answer)} <span>{escape(MEANINGS[answer])}</span></li>"
        for answer, count in report.counts.items()
    ]
    if report.waiting:
        items.append(
            f'<li><b>{len(report.waiting)}</b> <span class="badge">not yet judged</span> '
            "<span>no derivation states them so far</span></li>"
        )
    outcomes = Counter(result.finding.outcome for result in report.claims)
    if outcomes:
        told = ", ".join(f"{count} {word(outcome)}" for outcome, count in outcomes.items())
        items.append(f'<li><b>{len(report.claims)}</b> <span class="badge">claims</span> <span>{told}</span></li>')
    changed = "".join(f"<li>{escape(change)}</li>" for change in report.changes)
    warning = f'<div class="changed"><p>Changed against the record:</p><ul>{changed}</ul></div>' if changed else ""
    return f'<ul class="summary">{"".join(items)}</ul>{warning}'


def _table(report: Report) -> str:
    rows = [
        (_link(v.id), escape(equation(v.id).title), _badge(v.verdict), f"<small>{escape(note(v))}</small>")
        for v in report.verdicts
    ]
    return _rows(("Equation", "Title", "Verdict", "Order or condition"), rows, "verdicts")


def _equation(verdict: Verdict, report: Report) -> str:
    entry, statement = equation(verdict.id), verdict.statement
    printed = _formulas(sides(statement.relations, "printed"))
    derived = _formulas(sides(statement.relations, "derived")) or "<p>nothing to derive</p>"
    layout = "pair" if max(len(printed), len(derived)) < _WIDEST else "stack"
    read = f"<h4>As read</h4>{printed}" if printed else ""
    steps = "".join(f"<li>{escape(step)}</li>" for step in statement.steps)
    details = f"<details><summary>Steps</summary><ol>{steps}</ol></details>" if steps else ""
    said = "".join(_fact(fact) for fact in facts(verdict, report))
    return (
        f'<article id="eq-{verdict.id}"><h3><span class="id">{verdict.id}</span> {escape(entry.title)} '
        f"{_badge(verdict.verdict)}</h3>"
        f'<div class="{layout}"><div><h4>As printed</h4><pre><code>{escape(entry.latex)}</code></pre>{read}'
        f"</div><div><h4>As derived</h4>{derived}</div></div>"
        f"<dl>{said}</dl>{details}</article>"
    )


def _fact(fact: Fact) -> str:
    symbols = "".join(f" {mathml(letter, display=False)}" for letter in fact.formulas if letter.is_Symbol)
    parts = [f"<p>{escape(text)}{symbols}</p>" for text in fact.texts]
    parts += [f"<p>{' '.join(map(_link, fact.ids))}</p>"] * bool(fact.ids)
    parts.append(_formulas(formula for formula in fact.formulas if not formula.is_Symbol))
    return f"<div><dt>{escape(fact.label)}</dt><dd>{''.join(parts)}</dd></div>"


def _erratum(e: Erratum, statement: Statement) -> str:
    correct = "".join(
        f"<p><code>{escape(name)} =</code></p>{_formulas([relation.printed])}"
        for name, relation in zip(statement.quantities, statement.correction, strict=False)
    )
    used = " ".join(map(_link, e.used_by)) or "none"
    return (
        f'<article id="erratum-{e.id}"><h3>{_link(e.id)} {escape(e.title)}</h3><p>{escape(e.wrong)}</p>'
        f'<div class="stack"><div><h4>Printed</h4><pre><code>{escape(e.printed)}</code></pre></div>'
        f"<div><h4>Correct ({escape(e.verdict_of_correction)})</h4>{correct}</div></div>"
        f"<p><small>Used by: {used}; {escape(e.reach)}.</small></p></article>"
    )


def _claim(result: Result) -> str:
    entry, finding = claims()[result.trial.id], result.finding
    rows = [(escape(name.replace("_", " ")), f"{value:.6g}") for name, value in result.measured.items()]
    condition = f"<p><b>If:</b> {escape(finding.condition)}</p>" if finding.condition else ""
    return (
        f'<article id="claim-{entry.id}"><h3><span class="id">{entry.id}</span> {_badge(finding.outcome)}</h3>'
        f"<blockquote>{escape(entry.text)}</blockquote><p>{escape(finding.explanation)}</p>{condition}"
        f"<details><summary>Measured ({escape(result.trial.model)}, {result.seconds:.1f} s)</summary>"
        f"{_rows(('What', 'Value'), rows)}</details></article>"
    )


def _past(report: Report) -> list[str]:
    """Table, findings and figures of the theory that the paper does not have; empty where there is none."""
    return [
        *(_side_by_side(table, report) for table in report.past),
        *(f"<h3>{escape(title)}</h3><p>{escape(text)}</p>" for title, text in report.theory),
        *(_picture(picture) for picture in report.past_pictures),
    ]


def _side_by_side(table: Table, report: Report) -> str:
    rows = [tuple(_cell(cell, report) for cell in row) for row in table.rows]
    return (
        f'<h3>{escape(table.title)}</h3><div class="wide" tabindex="0">{_rows(table.head, rows)}</div>'
        f"<p><small>{escape(table.note)}</small></p>"
    )


def _cell(cell: Cell, report: Report) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(_cell(part, report) for part in cell)
    if isinstance(cell, FigureLink):
        drawn = any(picture.key == cell.key for picture in report.pictures)
        return f'<a href="#figure-{cell.key}">figure {cell.key}</a>' if drawn else f"figure {escape(cell.key)}"
    return mathml(cell, display=False) if isinstance(cell, sp.Basic) else escape(cell)


def _picture(picture: Picture) -> str:
    as_svg = picture.svg.stat().st_size <= _LARGEST_SVG
    file, kind = (picture.svg, "svg+xml") if as_svg else (picture.png, "png")
    source = f"data:image/{kind};base64,{b64encode(file.read_bytes()).decode()}"
    rows = [(escape(name), f"{value:.6g}") for name, value in picture.measured.items()]
    return (
        f'<figure id="figure-{picture.key}"><h3>Figure {picture.key}: {escape(picture.title)}</h3>'
        f'<img src="{source}" alt="{escape(picture.alt)}"><figcaption>{escape(picture.caption)}</figcaption>'
        f"{_rows(('Measured', 'Value'), rows) if rows else ''}</figure>"
    )


def _made(report: Report) -> str:
    rows = [(escape(name), escape(number)) for name, number in versions().items()]
    rows += [
        ("Judging", f"{sum(v.seconds for v in report.verdicts):.1f} s"),
        *([("Claims", f"{sum(c.seconds for c in report.claims):.1f} s")] if report.claims else []),
        *((f"Figure {p.key}", f"{p.seconds:.1f} s") for p in report.pictures),
        ("In all", f"{report.seconds:.1f} s"),
    ]
    return _rows(("What", "Version or time"), rows)


def _rows(head: tuple[str, ...], rows: Iterable[tuple[str, ...]], kind: str = "plain") -> str:
    """A table of cells that are HTML already."""
    top = "".join(f'<th scope="col">{escape(cell)}</th>' for cell in head)
    lines = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<table class="{kind}"><thead><tr>{top}</tr></thead><tbody>{lines}</tbody></table>'


def _formulas(expressions: Iterable[sp.Basic]) -> str:
    return "".join(f'<div class="wide" tabindex="0">{mathml(expression)}</div>' for expression in expressions)


def _badge(answer: str) -> str:
    return f'<span class="badge {answer}">{escape(word(answer))}</span>'


def _link(identifier: str) -> str:
    return f'<a href="#eq-{identifier}">{identifier}</a>'
