"""HTML elements of the pages: tables, formulas, links, coloured verdicts, and the cells of a derivation."""

import re
from base64 import b64encode
from collections.abc import Iterable, Mapping
from functools import cache
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.glossary import formulas, latex
from lagrotor.paper.claim_tests import ClaimTest
from lagrotor.paper.equation_statements import Stated
from lagrotor.paper.plain_text import readable_on_page
from lagrotor.paper.proof import Formula, Remark, Step
from lagrotor.paper.scripts import Script
from lagrotor.paper.tables import Cell, FigureLink, Table
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import Report, anchor, word
from lagrotor.report.facts import Fact
from lagrotor.report.formulas.mathml_latex import converter, mathml

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure


# `plain_text` does not treat a non-numeric index, a non-integer power, or a name of the program.
_INDEX = re.compile(r"(?<![\w&])([A-Za-zͰ-Ͽ][\u0307\u0308]?)_([A-Za-z0-9]+(?:_[A-Za-z0-9]+)*)")
_POWER = re.compile(r"\^(−?[\w.]+\w|−?\w|\([^()]*\))")
_CODE = re.compile(r"(?<![\w&.])([A-Za-z][A-Za-z0-9]+(?:_\w+)+)")


def prose(text: str) -> str:
    """Return plain text as HTML: its formulas become readable, and LaTeX between dollar signs is typeset."""
    plain, *segments = text.split("$")
    pieces = [_plain(plain)]
    for n, piece in enumerate(segments):
        formula = mathml(piece, display=False) if n % 2 == 0 and n + 1 < len(segments) else None
        pieces.append(formula or _plain(piece))
    return "".join(pieces)


def _plain(text: str) -> str:
    html = escape(readable_on_page(text))
    html = _CODE.sub(r"<code>\1</code>", html)
    indexed = _INDEX.sub(lambda match: f"{match[1]}<sub>{match[2].replace('_', ',')}</sub>", html)
    return _POWER.sub(r"<sup>\1</sup>", indexed)


def html_table(head: tuple[str, ...], lines: Iterable[tuple[str, ...]], kind: str = "plain") -> str:
    """Return a table of HTML cells; the first cell of each line is its header."""
    heads = [escape(readable_on_page(cell), quote=True) for cell in head[1:]]
    top = "".join(f'<th scope="col">{prose(cell)}</th>' for cell in head)
    rows = (f'<tr><th scope="row">{first}</th>{"".join(map(_under, heads, cells))}</tr>' for first, *cells in lines)
    return f'<div class="wide"><table class="{kind}"><thead><tr>{top}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'


def _under(head: str, cell: str) -> str:
    """Return a table cell that carries the heading of its column; a narrow screen shows it before the cell."""
    return f'<td data-head="{head}">{cell}</td>' if head else f"<td>{cell}</td>"


def number_list(what: str, measured: Iterable[tuple[str, float]]) -> str:
    """Return an HTML table of measured numbers with six digits; `what` is the heading of the column of names."""
    return html_table(
        (what, "Value"), ((prose(name.replace("_", " ")), prose(f"{value:.6g}")) for name, value in measured)
    )


def side_by_side(table: Table, report: Report) -> str:
    """Return the HTML of a table from a derivation, with its title above and its note below."""
    lines = [tuple(_cell(cell, report) for cell in row) for row in table.rows]
    note = f"<p><small>{prose(table.note)}</small></p>" if table.note else ""
    return (
        f'<div class="table">{foldable(f"<h3>{prose(table.title)}</h3>", html_table(table.head, lines) + note)}</div>'
    )


def _cell(cell: Cell, report: Report) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(_cell(line, report) for line in cell)
    if isinstance(cell, FigureLink):
        drawn = any(picture.key == cell.key for picture in report.pictures)
        return links([f"figure {cell.key}"]) if drawn else f"figure {escape(cell.key)}"
    return inline(cell) if isinstance(cell, sp.Basic) else prose(cell)


def fact_list(facts: Iterable[Fact]) -> str:
    """Return facts as an HTML description list; "" if there are none."""
    items = "".join(map(_fact, facts))
    return f"<dl>{items}</dl>" if items else ""


def _fact(fact: Fact) -> str:
    symbols = "".join(f" {inline(letter)}" for letter in fact.formulas if letter.is_Symbol)
    paragraphs = [f"<p>{prose(text)}{symbols}</p>" for text in fact.texts]
    paragraphs += [f"<p>{links(fact.ids)}</p>"] * bool(fact.ids)
    paragraphs += [typeset(latex(formula)) for formula in fact.formulas if not formula.is_Symbol]
    paragraphs += map(typeset, fact.sources)
    return f"<div><dt>{escape(fact.label)}</dt><dd>{''.join(paragraphs)}</dd></div>"


def inline(expression: sp.Basic) -> str:
    """Return an expression as a formula within a line of text, or as LaTeX if the converter is not installed."""
    source = latex(expression)
    return mathml(source, display=False) or f"<code>{escape(source)}</code>"


def typeset(source: str) -> str:
    """Return LaTeX as a formula on its own line. If the converter is missing or fails, return the source with a note."""
    formula = mathml(source)
    if formula is None:
        why = "latex2mathml cannot convert this" if converter() else "install latex2mathml to have it typeset"
        return f"{code(source)}<p><small>LaTeX: {why}.</small></p>"
    return f'<div class="wide">{formula}</div>'


def code(source: str) -> str:
    """Return source text as an HTML element whose lines may break."""
    return f"<pre><code>{escape(source)}</code></pre>"


def fold(summary: str, inside: str, kind: str = "fold") -> str:
    """Return HTML that shows `summary` only, until the reader unfolds the content."""
    return f'<details class="{kind}"><summary>{escape(summary)}</summary>{inside}</details>'


def foldable(heading: str, inside: str) -> str:
    """Return a heading and its content, which page.js folds on a narrow screen."""
    return f'<details class="entry" open><summary>{heading}</summary>{inside}</details>'


def badge(answer: str) -> str:
    """Return the HTML of a verdict or an outcome on a field of its colour."""
    return f'<span class="badge {answer}">{escape(word(answer))}</span>'


def link(identifier: str) -> str:
    """Return a link to the equation, claim or figure with this id."""
    return f'<a href="#{anchor(identifier)}">{escape(identifier)}</a>'


def file_link(name: str) -> str:
    """Return a link to a file in the folder of the page."""
    return f'<a href="{name}">{name}</a>'


def links(identifiers: Iterable[str]) -> str:
    return " ".join(f'<span class="id">{link(identifier)}</span>' for identifier in identifiers)


def heading(name: str, title: str, answer: str = "") -> str:
    """Return the heading of an entry: its name such as "5.07", its title and its verdict.

    A comma, which only a screen reader or a copy shows, separates the title from the verdict.
    """
    mark = f'<span class="unseen">,</span> {badge(answer)}' if answer else ""
    return f'<h3><span class="id">{escape(name)}</span> {prose(title)}{mark}</h3>'


def derivation_html(script: Script, answers: Mapping[str, str]) -> str:
    """Return the HTML of a derivation, cell by cell, without its title; `answers` maps an equation to its verdict."""
    html = ""
    for cell in script.cells:
        html += markdown_html(re.sub(r"\A# .*\n?", "", cell.text) if cell.kind == "prose" else "")
        html += "".join(_value_html(value, answers) for value in cell.values)
        html += "".join(f"<p><small>Warning of the simulation: {prose(text)}.</small></p>" for text in cell.warned)
    return html


def title(script: Script, stem: str) -> str:
    """Return the first line of text of a derivation, which is its title; its stem if it has no text."""
    text = next((cell.text for cell in script.cells if cell.kind == "prose"), stem)
    return text.splitlines()[0].lstrip("# ")


def markdown_html(text: str) -> str:
    """Return Markdown, with formulas between dollar signs, as HTML; its source if markdown-it is not installed."""
    try:
        renderer = _renderer()
    except ModuleNotFoundError:
        return f"<pre>{escape(text)}</pre>"
    text = re.sub(r"\s*(\$\$.+?\$\$)\s*", r"\n\n\1\n\n", text, flags=re.DOTALL)  # a displayed formula is a paragraph
    html: str = renderer.render(text)
    html = html.replace('<div class="math block">', '<div class="wide">')  # reduced or scrolled like every formula
    html = re.sub(r'<span class="math inline">(<math.*?</math>)</span>', r"\1", html, flags=re.DOTALL)
    for level in (3, 2, 1):  # below a heading of the page
        html = html.replace(f"<h{level}>", f"<h{level + 1}>").replace(f"</h{level}>", f"</h{level + 1}>")
    return html


@cache
def _renderer() -> Any:
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    return (
        MarkdownIt("commonmark", {"html": False})
        .enable("table")
        .use(dollarmath_plugin, renderer=_formula, allow_space=False)
    )


def _formula(source: str, options: Mapping[str, Any]) -> str:
    from lagrotor.report.formulas.mathml_latex import mathml

    drawn = mathml(source, display=bool(options["display_mode"]))
    return drawn or f"<code>{escape(source)}</code>"


def _value_html(value: Any, answers: Mapping[str, str]) -> str:
    if isinstance(value, tuple | list):
        return "".join(_value_html(item, answers) for item in value)
    if isinstance(value, Step):
        how = "exactly" if value.small is None else f"through order {value.order or 0}"
        says = f"<p><small>Decided {how}: {prose(value.says)}.</small></p>" if value.says else ""
        return f'<div class="step">{typeset(value.tex)}{says}</div>'
    if isinstance(value, Formula):
        return typeset(value.tex)
    if isinstance(value, Stated):
        answer = badge(answers[value.id]) if value.id in answers else ""
        return f'<p class="judged"><a href="#{anchor(value.id)}">{escape(value.id)}</a> {answer}</p>'
    if isinstance(value, ClaimTest):
        return f'<p class="judged">Outcome and measured numbers: <a href="#{anchor(value.id)}">{value.id}</a></p>'
    if isinstance(value, Remark):
        return f"<p><b>{prose(value.title)}.</b> {prose(value.text)}</p>"
    if isinstance(value, Table):
        note = f"<p><small>{prose(value.note)}</small></p>" if value.note else ""
        rows = (tuple(_derived_cell(cell) for cell in row) for row in value.rows)
        return f"<p><b>{prose(value.title)}.</b></p>{html_table(value.head, rows)}{note}"
    if isinstance(value, Equations):
        parts = formulas(value).items()
        return "".join(f"<p>{name}</p>{''.join(map(typeset, lines))}" for name, lines in parts)
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return typeset(Formula(value).tex)
    if isinstance(value, str | float):
        return f"<p>{prose(value if isinstance(value, str) else f'{value:.6g}')}</p>"
    from lagrotor.drawing.run_figure import RunFigure

    if isinstance(value, RunFigure):
        labels = ", ".join(axes.get_ylabel().replace("$", "") for axes in value.axes)
        return f'<img src="{_png(value)}" alt="Over time: {escape(labels)}">'
    return ""


def _png(figure: "RunFigure") -> str:
    """Return a figure as a `data:` address, at low resolution and in 64 colours, because a page has many figures."""
    from PIL import Image

    from lagrotor.drawing.style import laid_out

    with BytesIO() as file, BytesIO() as small:
        with laid_out(figure, dpi=72):
            figure.savefig(file, format="rgba")
            drawn = Image.frombytes("RGBA", figure.canvas.get_width_height(), file.getvalue())
        drawn.convert("RGB").quantize(64).save(small, format="png")
        return "data:image/png;base64," + b64encode(small.getvalue()).decode()


def _derived_cell(cell: Any) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_derived_cell, cell))
    return typeset(Formula(cell).tex) if isinstance(cell, sp.Basic) else prose(str(getattr(cell, "key", cell)))


def link_to_derivation(identifier: str, report: Report) -> str:
    """Return a link to the derivation of an equation; "" if the report does not contain this derivation."""
    stem, _ = report.paper.scripts.stating.get(identifier, ("", 0))
    is_listed = any(stem == derived for derived, _, _ in report.derivations)
    return f'<p><a href="#derivation-{stem}">The derivation</a> of {link(identifier)}</p>' if is_listed else ""


# In a data address # ends it and % begins an escape; an attribute cannot contain the others. % must come first.
_ESCAPED = {"%": "%25", "#": "%23", "<": "%3C", ">": "%3E", "&": "%26", '"': "'"}


def data_address(picture: Picture) -> str:
    """Return the SVG of a picture as a `data:` address, which a page can contain."""
    source = picture.svg.read_text(encoding="utf-8")
    for character, escaped in _ESCAPED.items():
        source = source.replace(character, escaped)
    return f"data:image/svg+xml,{source}"


def size(picture: Picture) -> tuple[int, int]:
    """Return the width and height of a picture in points, rounded, from its SVG."""
    box = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', picture.svg.read_text(encoding="utf-8"))
    return (round(float(box[1])), round(float(box[2]))) if box else (1, 1)
