"""A derivation as part of the page: its prose, the steps that it proves, the verdicts where they are reached."""

import re
from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.paper.proof import Formula, Remark, Step
from lagrotor.paper.scripts import Script
from lagrotor.paper.stating import Stated
from lagrotor.paper.tables import Table
from lagrotor.report.content import Report, anchor
from lagrotor.report.page.page_pieces import badge, html_table, link, prose, typeset

if TYPE_CHECKING:
    from lagrotor.drawing.run_figure import RunFigure


def derivation_html(script: Script, answers: Mapping[str, str]) -> str:
    """One derivation, cell by cell, without its title; `answers` holds the verdicts by equation."""
    html = ""
    for cell in script.cells:
        html += markdown_html(re.sub(r"\A# .*\n?", "", cell.text) if cell.kind == "prose" else "")
        html += "".join(_value_html(value, answers) for value in cell.shown)
        html += "".join(f"<p><small>The run warns: {prose(text)}.</small></p>" for text in cell.warned)
    return html


def title(script: Script, stem: str) -> str:
    """The first heading of a derivation; its name where it has none."""
    text = next((cell.text for cell in script.cells if cell.kind == "prose"), stem)
    return text.splitlines()[0].lstrip("# ")


def markdown_html(text: str) -> str:
    """Markdown with formulas between dollars as HTML; unchanged where markdown-it is not installed."""
    try:
        renderer = _renderer()
    except ModuleNotFoundError:
        return f"<pre>{escape(text)}</pre>"
    text = re.sub(r"\s*(\$\$.+?\$\$)\s*", r"\n\n\1\n\n", text, flags=re.DOTALL)  # a displayed formula is a paragraph
    html: str = renderer.render(text)
    html = html.replace('<div class="math block">', '<div class="wide">')  # drawn smaller or scrolled, as every formula
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
        return "".join(_value_html(part, answers) for part in value)
    if isinstance(value, Step):
        how = "exactly" if value.small is None else f"through order {value.order or 0}"
        says = f"<p><small>Decided {how}: {prose(value.says)}.</small></p>" if value.says else ""
        return f'<div class="step">{typeset(value.tex)}{says}</div>'
    if isinstance(value, Formula):
        return typeset(value.tex)
    if isinstance(value, Stated):
        answer = badge(answers[value.id]) if value.id in answers else ""
        return f'<p class="judged"><a href="#{anchor(value.id)}">{escape(value.id)}</a> {answer}</p>'
    if isinstance(value, Remark):
        return f"<p><b>{prose(value.title)}.</b> {prose(value.text)}</p>"
    if isinstance(value, Table):
        return html_table(value.head, (tuple(_cell(cell) for cell in row) for row in value.rows))
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return typeset(Formula(value).tex)
    from lagrotor.drawing.run_figure import RunFigure

    if isinstance(value, RunFigure):
        labels = ", ".join(axes.get_ylabel().strip("$") for axes in value.axes)
        return f'<img src="{_png(value)}" alt="Over time: {escape(labels)}">'
    return ""


def _png(figure: "RunFigure") -> str:
    """The figure as an address that holds it; coarse and in 64 colours, as many are on a page."""
    from PIL import Image

    from lagrotor.drawing.style import laid_out

    with BytesIO() as file, BytesIO() as small:
        with laid_out(figure, dpi=72):
            figure.savefig(file, format="rgba")
            drawn = Image.frombytes("RGBA", figure.canvas.get_width_height(), file.getvalue())
        drawn.convert("RGB").quantize(64).save(small, format="png")
        return "data:image/png;base64," + b64encode(small.getvalue()).decode()


def _cell(cell: Any) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_cell, cell))
    return typeset(Formula(cell).tex) if isinstance(cell, sp.Basic) else prose(str(getattr(cell, "key", cell)))


def link_to_derivation(identifier: str, report: Report) -> str:
    """A link to where an equation is derived on the page; nothing where its derivation is not in the report."""
    stem, _ = report.paper.scripts.stating.get(identifier, ("", 0))
    there = any(stem == shown for shown, _, _ in report.derivations)
    return f'<p><a href="#derivation-{stem}">The derivation</a> of {link(identifier)}</p>' if there else ""
