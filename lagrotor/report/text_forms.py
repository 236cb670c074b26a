"""The report's blocks as Markdown with LaTeX between dollar signs, as code hosts draw it, and as one LaTeX file, a supplement to
a paper: ASCII, compiled by pdflatex, its pictures in `figures/`."""

import re
from functools import partial

import sympy as sp

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.readable import readable
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
    errata_blocks,
    opening_blocks,
    section_blocks,
)
from lagrotor.report.content import SUBTITLE, Report, anchor, contents
from lagrotor.report.latex import (
    END,
    displayed_expression,
    displayed_formula,
    head,
    latex_inline,
    latex_prose,
    latex_table,
)


def markdown(report: Report) -> str:
    """The whole report; figures are linked as `figures/<stem>.svg`."""
    listed = "\n".join(f"- [{heading}](#{name})" for name, heading in contents(report))
    blocks = [f"# {report.title}", f"{SUBTITLE}.", *map(_block, opening_blocks(report)), listed]
    return "\n\n".join(filter(None, [*blocks, *map(_block, section_blocks(report))])) + "\n"


def errata_sheet(report: Report) -> str:
    """The errata alone, which lead to the report beside them."""
    blocks = map(partial(_block, beside="report.md"), errata_blocks(report))
    return "\n\n".join(["# Errata", *blocks]) + "\n"


def _block(block: Block, beside: str = "") -> str:
    """beside: the file of what it leads to."""
    match block:
        case list():
            return " ".join(filter(None, (_span(part, beside) for part in block)))
        case Heading(place, title, name):
            return f'<a id="{place}"></a>\n\n' + (f"### {name} {_prose(title)}" if name else f"## {title}")
        case Display(formula):
            return f"$$\n{formula if isinstance(formula, str) else latex(formula)}\n$$"
        case Rows(head, rows):
            lines = [tuple(map(_prose, head)), tuple("---" for _ in head), *(map(_span, row) for row in rows)]
            return "\n".join("| " + " | ".join(line) + " |" for line in lines) if rows else ""
        case Verbatim(text, quoted):
            return f"> {_prose(text)}" if quoted else f"```bibtex\n{text}\n```"
        case picture:
            return f"![{_prose(picture.alt)}](figures/{picture.svg.name})"


def _span(part: Span, beside: str = "") -> str:
    match part:
        case str():
            return _prose(part)
        case Bold(text):
            return f"**{_prose(text)}**"
        case Links(ids):
            return ", ".join(f"[{identifier}]({beside}#{anchor(identifier)})" for identifier in ids)
        case File(address, name):
            return f"[{name}]({address})"
        case tuple():
            return "<br>".join(map(_span, part))
        case formula:  # a bar would end the cell
            return f"${latex(formula)}$".replace(r"\left|", r"\left\lvert ").replace(r"\right|", r"\right\rvert ")


def _prose(text: str) -> str:
    """Text on one line in which nothing is read as Markdown, HTML or a table's edge."""
    return re.sub(r"([\\`*_\[\]<>|#$~])", r"\\\1", " ".join(readable(text).split()))


def supplement(report: Report) -> str:
    """The whole report, its sections in the order of the page."""
    blocks = [
        head(report.title, report.paper.about.preamble),
        rf"\title{{{latex_prose(report.title)}\\ \large {latex_prose(SUBTITLE)}}}",
        r"\author{}\date{}\maketitle",
        *map(_latex_block, opening_blocks(report)),
        r"\setcounter{tocdepth}{2}\tableofcontents",
        *map(_latex_block, section_blocks(report)),
    ]
    return "\n\n".join([*filter(None, blocks), END])


def _latex_block(block: Block) -> str:
    match block:
        case list():
            return " ".join(filter(None, map(_latex_span, block)))
        case Heading(place, title, ""):
            return rf"\section*{{{latex_prose(title)}}}\addcontentsline{{toc}}{{subsection}}{{{latex_prose(title)}}}"
        case Heading(place, title, name):
            return rf"\subsection*{{\hypertarget{{{place}}}{{{latex_prose(name)}}}\quad {latex_prose(title)}}}"
        case Display(formula):
            return displayed_formula(formula) if isinstance(formula, str) else displayed_expression(formula)
        case Rows(names, rows):
            lines = (tuple(map(_latex_cell, row)) for row in rows)
            return latex_table(tuple(map(latex_prose, names)), lines) if rows else ""
        case Verbatim(text, quoted):
            if quoted:
                return rf"\begin{{quote}}{latex_prose(text)}\end{{quote}}"
            return f"{{\\scriptsize\\begin{{verbatim}}\n{text}\n\\end{{verbatim}}}}"
        case picture:
            return rf"\drawn{{figures/{picture.png.name}}}"


def _latex_span(part: Span) -> str:
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
            return r"\par ".join(map(_latex_cell, part))
        case formula:
            return f"${latex_inline(formula)}$"


def _latex_cell(part: Span) -> str:
    """A formula that is more than a letter may be wider than its column."""
    return displayed_expression(part) if isinstance(part, sp.Basic) and not part.is_Symbol else _latex_span(part)
