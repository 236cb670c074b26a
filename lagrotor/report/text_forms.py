"""The report as a sequence of blocks, written as Markdown and as LaTeX.

Markdown has LaTeX between dollar signs. The LaTeX file is ASCII, compiles with pdflatex and reads its pictures from `figures/`.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import sympy as sp

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.plain_text import readable_on_page
from lagrotor.paper.tables import Cell, FigureLink
from lagrotor.paper.verdicts import Verdict
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import (
    BESIDE,
    CLAIM_MEANINGS,
    MEANINGS,
    SUBTITLE,
    Report,
    ResultSection,
    anchor,
    citation,
    claim_title,
    contents,
    derived_heading,
    derived_lines,
    notation,
    word,
)
from lagrotor.report.errata import (
    LETTER_HEAD,
    LETTERS_FIRST,
    PREMISES_CITED,
    cited_premises,
    errata,
    letter_table,
    listed_premises,
    premise_text,
    sheet_summary,
)
from lagrotor.report.facts import Fact, balance, facts, figure_facts, headlines, linked_facts, note, opening, unmet
from lagrotor.report.latex import (
    END,
    displayed_expression,
    displayed_formula,
    head,
    latex_inline,
    latex_prose,
    latex_table,
)


@dataclass(frozen=True)
class Bold:
    """Bold text: a label, or a title to which no link leads."""

    text: str


@dataclass(frozen=True)
class Links:
    """Links to the equations, claims or figures with these ids."""

    ids: tuple[str, ...]


@dataclass(frozen=True)
class File:
    """A link to a file of the report's folder: its relative address and the name to show."""

    address: str
    name: str


Span: TypeAlias = (
    "str | sp.Basic | Bold | Links | File | Display | tuple[Span, ...]"  # in a line or cell; a tuple is stacked
)
Line: TypeAlias = list[Span]  # joined by spaces


@dataclass(frozen=True)
class Heading:
    """The heading of a section, or of an entry if it has a `name` such as "5.07"; `place` is its anchor."""

    place: str
    title: str
    name: str = ""


@dataclass(frozen=True)
class Display:
    """A formula on its own line, given as LaTeX or as an expression; within a line or a cell it is LaTeX."""

    formula: str | sp.Basic


@dataclass(frozen=True)
class Rows:
    """A table with a head and rows."""

    head: tuple[str, ...]
    rows: Sequence[tuple[Span, ...]]


@dataclass(frozen=True)
class Verbatim:
    """Preformatted text, or a quotation of the paper."""

    text: str
    quoted: bool = False


Block: TypeAlias = "Line | Heading | Display | Rows | Verbatim | Picture"


def opening_blocks(report: Report) -> Iterator[Block]:
    """Yield the blocks above the sections."""
    for label, text in opening(report):
        yield [Bold(label), text]
    yield [report.how_to_read]


def section_blocks(report: Report) -> Iterator[Block]:
    """Yield the blocks of every section, each section after its heading."""
    for name, heading in contents(report):
        yield Heading(name, heading)
        if name in _PARTS:
            yield from _PARTS[name](report)
        elif name.startswith("section-"):
            for verdict in report.sections[name.removeprefix("section-")]:
                yield from _equation(verdict, report)
        else:
            yield from _result_section(report.result_section(name), report)


def _summary(report: Report) -> Iterator[Block]:
    if report.changes:
        yield [Bold("Verdicts that differ from the record."), "; ".join(report.changes)]
    yield [balance(report)]
    if refuted := [v.id for v in report.verdicts if v.verdict == "refuted"]:
        yield ["Refuted:", Links(tuple(refuted))]
    for number, headline in enumerate(headlines(report), 1):
        yield [Bold(f"{number}. {headline.title}."), headline.text]
        if headline.formula:
            yield Display(headline.formula)
        if headline.ids:
            yield ["Shown in", Links(headline.ids)]
    for what, counts, meanings in (("Equations", report.counts, MEANINGS), ("Claims", report.outcomes, CLAIM_MEANINGS)):
        rows = [(word(answer), str(count), meanings[answer]) for answer, count in counts.items()]
        yield Rows((what, "Number", "Meaning"), rows)


def _verdicts(report: Report) -> Iterator[Block]:
    if text := unmet(report):
        yield [text]
    rows = [(Links((v.id,)), report.paper.equation(v.id).title, word(v.verdict), note(v)) for v in report.verdicts]
    yield Rows(("Equation", "Title", "Verdict", "Reason or condition"), rows)


def errata_blocks(report: Report) -> Iterator[Block]:
    """Yield the blocks of the errata sheet; none if no equation is refuted."""
    errors = list(errata(report.verdicts, report.paper))
    if not errors:
        return
    for sentence in sheet_summary(report.verdicts, errors):
        yield [sentence]
    rows = letter_table(errors, report.paper)
    if rows:
        yield [LETTERS_FIRST]
    yield Rows(LETTER_HEAD, [(Display(tex), *texts) for tex, *texts in rows])
    listed = listed_premises(errors)
    if listed:
        yield [PREMISES_CITED]
    for number, premise in enumerate(listed, 1):
        yield [Bold(f"P{number}:"), f"{premise_text(premise)}."]
    for e in errors:
        yield Heading(f"erratum-{e.id}", e.title, f"Erratum {e.id}:")
        yield [Bold(f"{e.cited.capitalize()}."), e.wrong]
        yield [Bold("Printed.")]
        yield Display(e.printed)
        yield [Bold(f"Corrected equation ({e.verdict_of_correction}).")]
        yield from map(Display, e.corrected)
        for label, premises in e.conditions:
            yield [Bold(f"{label}:"), f"{cited_premises(premises, listed)}."]
        yield ["Used by:", Links(e.used_by) if e.used_by else "none", f"– {e.reach}."]


def _equation(verdict: Verdict, report: Report) -> Iterator[Block]:
    entry, relations = report.paper.equation(verdict.id), verdict.statement.relations
    yield Heading(anchor(verdict.id), f"{entry.title}: {word(verdict.verdict)}", verdict.id)
    yield [Bold("As printed.")]
    yield Display(entry.latex)
    if derived := derived_lines(relations):
        yield [Bold(f"{derived_heading(relations)}.")]
        yield from map(Display, derived)
    yield from _facts(facts(verdict, report))


def _facts(listed: Iterable[Fact]) -> Iterator[Block]:
    for fact in listed:
        letters = [letter for letter in fact.formulas if letter.is_Symbol]
        yield [Bold(f"{fact.label}:"), *fact.texts, Links(fact.ids), *letters]
        yield from (Display(formula) for formula in fact.formulas if not formula.is_Symbol)
        yield from map(Display, fact.sources)


def _claim(result: Result, report: Report) -> Iterator[Block]:
    entry, finding = report.paper.claims[result.test.id], result.finding
    yield Heading(anchor(entry.id), f"{claim_title(entry)}: {word(finding.outcome)}", entry.id)
    yield Verbatim(entry.text, quoted=True)
    yield [finding.explanation]
    if finding.condition:
        yield [Bold("Condition:"), finding.condition]
    yield from _facts(linked_facts(result, report))
    yield _numbers(f"Measured ({result.test.model})", result.measured)


def _numbers(title: str, measured: Mapping[str, float]) -> Rows:
    return Rows((title, "Value"), [(name.replace("_", " "), f"{value:.6g}") for name, value in measured.items()])


def _result_section(section: ResultSection, report: Report) -> Iterator[Block]:
    for table in section.tables:
        yield [Bold(f"{table.title}.")]
        yield Rows(table.head, [tuple(_cell(cell, report) for cell in row) for row in table.rows])
        yield [table.note]
    for title, text in section.remarks:
        yield [Bold(f"{title}."), text]
    for picture in section.pictures:
        key = f"figure {picture.key}"
        yield Heading(anchor(key), picture.title, f"{key.capitalize()}:")
        yield picture
        yield [picture.caption]
        yield from _facts(figure_facts(picture, report))
        yield _numbers("Measured", picture.measured)


def _cell(cell: Cell, report: Report) -> Span:
    if not isinstance(cell, FigureLink):
        return cell
    key = f"figure {cell.key}"
    return Links((key,)) if any(picture.key == cell.key for picture in report.pictures) else key


def _derivations(report: Report) -> Iterator[Block]:
    rows = [(name, File(f"pages/derivation-{stem}.html", f"{stem}.py")) for stem, name, _ in report.derivations]
    yield Rows(("Derivation", "Script"), rows)


def _cite(_: Report) -> Iterator[Block]:
    sentences, entry = citation()
    for sentence in sentences:
        yield [sentence]
    yield Verbatim(entry)


def _made(report: Report) -> Iterator[Block]:
    yield ["The same inputs give the same file, byte for byte. The computing times are in times.json."]
    yield Rows(("File in the same folder", "Content"), [(File(file, file), what) for file, what in BESIDE.items()])
    yield Rows(("Software", "Version"), list(report.versions))
    yield Rows(("Input", "SHA-256"), list(report.inputs))


_PARTS: dict[str, Callable[[Report], Iterator[Block]]] = {
    "model": lambda _: iter(
        [["The interactive model of the pair, for a browser:", File("index.html#model", "index.html")]]
    ),
    "summary": _summary,
    "verdicts": _verdicts,
    "notation": lambda report: iter([Rows(("Symbol", "Meaning", "Unit"), list(notation(report)))]),
    "errata": errata_blocks,
    "claims": lambda report: (block for result in report.claims for block in _claim(result, report)),
    "derivations": _derivations,
    "waiting": lambda report: iter([Rows(("Equation", "Title"), [(e.id, e.title) for e in report.waiting])]),
    "cite": _cite,
    "made": _made,
}


def markdown(report: Report) -> str:
    """Return the whole report as Markdown; it links figures as `figures/<stem>.svg`."""
    listed = "\n".join(f"- [{heading}](#{name})" for name, heading in contents(report))
    blocks = [f"# {report.title}", f"{SUBTITLE}.", *map(_block, opening_blocks(report)), listed]
    return "\n\n".join(filter(None, [*blocks, *map(_block, section_blocks(report))])) + "\n"


def errata_sheet(report: Report) -> str:
    """Return the errata sheet as Markdown; its links lead into report.md."""
    blocks = map(partial(_block, target="report.md"), errata_blocks(report))
    return "\n\n".join(["# Errata", *blocks]) + "\n"


def _block(block: Block, target: str = "") -> str:
    """Return a block as Markdown; links lead into the file `target`."""
    match block:
        case list():
            return " ".join(filter(None, (_span(span, target) for span in block)))
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


def _span(span: Span, target: str = "") -> str:
    match span:
        case str():
            return _prose(span)
        case Bold(text):
            return f"**{_prose(text)}**"
        case Links(ids):
            return ", ".join(f"[{identifier}]({target}#{anchor(identifier)})" for identifier in ids)
        case File(address, name):
            return f"[{name}]({address})"
        case Display(str(formula)):
            return f"${formula}$"
        case tuple():
            return "<br>".join(map(_span, span))
        case formula:  # a bar would end the cell
            return f"${latex(formula)}$".replace(r"\left|", r"\left\lvert ").replace(r"\right|", r"\right\rvert ")


def _prose(text: str) -> str:
    """Return text on one line, in which characters with a meaning in Markdown, HTML or tables are escaped."""
    return re.sub(r"([\\`*_\[\]<>|#$~])", r"\\\1", " ".join(readable_on_page(text).split()))


def supplement(report: Report) -> str:
    """Return the whole report as LaTeX."""
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


def _latex_span(span: Span) -> str:
    match span:
        case str():
            return latex_prose(span)
        case Bold(text):
            return rf"\textbf{{{latex_prose(text)}}}"
        case Links(ids):
            return ", ".join(rf"\hyperlink{{{anchor(identifier)}}}{{{latex_prose(identifier)}}}" for identifier in ids)
        case File(_, name):
            return latex_prose(name)
        case Display(str(formula)):
            return f"${formula}$"
        case tuple():
            return r"\par ".join(map(_latex_cell, span))
        case formula:
            return f"${latex_inline(formula)}$"


def _latex_cell(span: Span) -> str:
    """Return a cell in LaTeX. A formula longer than one symbol is set so that it may break, to fit its column."""
    return displayed_expression(span) if isinstance(span, sp.Basic) and not span.is_Symbol else _latex_span(span)
