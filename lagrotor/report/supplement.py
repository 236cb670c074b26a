"""The report as one LaTeX file, a supplement to a paper: ASCII, compiled by pdflatex, its pictures in `figures/`."""

import sympy as sp

from lagrotor.report.blocks import (
    Block,
    Bold,
    Display,
    File,
    Heading,
    Links,
    Rows,
    Span,
    Verbatim,
    opening_blocks,
    section_blocks,
)
from lagrotor.report.content import SUBTITLE, Report, anchor
from lagrotor.report.latex import (
    END,
    displayed_expression,
    displayed_formula,
    head,
    latex_inline,
    latex_prose,
    latex_table,
)


def supplement(report: Report) -> str:
    """The whole report, its sections in the order of the page."""
    blocks = [
        head(report.title, report.paper.about.preamble),
        rf"\title{{{latex_prose(report.title)}\\ \large {latex_prose(SUBTITLE)}}}",
        r"\author{}\date{}\maketitle",
        *map(_block, opening_blocks(report)),
        r"\setcounter{tocdepth}{2}\tableofcontents",
        *map(_block, section_blocks(report)),
    ]
    return "\n\n".join([*filter(None, blocks), END])


def _block(block: Block) -> str:
    match block:
        case list():
            return " ".join(filter(None, map(_span, block)))
        case Heading(place, title, ""):
            return rf"\section*{{{latex_prose(title)}}}\addcontentsline{{toc}}{{subsection}}{{{latex_prose(title)}}}"
        case Heading(place, title, name):
            return rf"\subsection*{{\hypertarget{{{place}}}{{{latex_prose(name)}}}\quad {latex_prose(title)}}}"
        case Display(formula):
            return displayed_formula(formula) if isinstance(formula, str) else displayed_expression(formula)
        case Rows(names, rows):
            lines = (tuple(map(_cell, row)) for row in rows)
            return latex_table(tuple(map(latex_prose, names)), lines) if rows else ""
        case Verbatim(text, quoted):
            if quoted:
                return rf"\begin{{quote}}{latex_prose(text)}\end{{quote}}"
            return f"{{\\scriptsize\\begin{{verbatim}}\n{text}\n\\end{{verbatim}}}}"
        case picture:
            return rf"\drawn{{figures/{picture.png.name}}}"


def _span(part: Span) -> str:
    match part:
        case str():
            return latex_prose(part)
        case Bold(text):
            return rf"\textbf{{{latex_prose(text)}}}"
        case Links(ids):
            return ", ".join(rf"\hyperlink{{{anchor(each)}}}{{{latex_prose(each)}}}" for each in ids)
        case File(_, name):
            return latex_prose(name)
        case tuple():
            return r"\par ".join(map(_cell, part))
        case formula:
            return f"${latex_inline(formula)}$"


def _cell(part: Span) -> str:
    """A formula that is more than a letter may be wider than its column."""
    return displayed_expression(part) if isinstance(part, sp.Basic) and not part.is_Symbol else _span(part)
