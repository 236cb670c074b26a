"""The report as one LaTeX file, a supplement to a paper: ASCII, compiled by pdflatex, its pictures in `figures/`."""

from collections.abc import Callable, Iterable

import sympy as sp

from lagrotor.paper.claim_tests import Result
from lagrotor.paper.tables import Cell, FigureLink, Table
from lagrotor.paper.verdicts import Verdict
from lagrotor.pictures.figures import Picture
from lagrotor.report.cite import citation
from lagrotor.report.content import (
    CLAIM_MEANINGS,
    MEANINGS,
    SUBTITLE,
    Report,
    ShownPart,
    anchor,
    contents,
    derived_heading,
    derived_lines,
    made_beside,
    notation,
    word,
)
from lagrotor.report.errata import errata, latex_block
from lagrotor.report.facts import Fact, facts, figure_facts, linked_facts, note
from lagrotor.report.latex import (
    END,
    displayed_expression,
    displayed_formula,
    head,
    latex_inline,
    latex_prose,
    latex_table,
)
from lagrotor.report.results import Headline, balance, headlines, opening


def supplement(report: Report) -> str:
    """The whole report, its sections in the order of the page; the live model is the page's alone."""
    blocks = [
        rf"\title{{{latex_prose(report.title)}\\ \large {latex_prose(SUBTITLE)}}}",
        r"\author{}\date{}\maketitle",
        *(rf"\textbf{{{label}}} {latex_prose(text)}" for label, text in opening(report)),
        latex_prose(report.how_to_read),
    ]
    blocks += [r"\setcounter{tocdepth}{2}\tableofcontents"]
    for name, heading in contents(report):
        if name != "model":
            blocks.append(
                rf"\section*{{{latex_prose(heading)}}}\addcontentsline{{toc}}{{subsection}}{{{latex_prose(heading)}}}"
            )
            blocks += _section(report, name)
    return "\n\n".join([head(report.title, report.paper.about.preamble), *filter(None, blocks), END])


def _section(report: Report, name: str) -> list[str]:
    if name.startswith("section-"):
        return [_equation(verdict, report) for verdict in report.sections[name.removeprefix("section-")]]
    return _PARTS[name](report) if name in _PARTS else _shown(report.part(name), report)


def _summary(report: Report) -> list[str]:
    rows = [(word(answer), str(count), latex_prose(MEANINGS[answer])) for answer, count in report.counts.items()]
    tried = [
        (word(answer), str(count), latex_prose(CLAIM_MEANINGS[answer])) for answer, count in report.outcomes.items()
    ]
    changes = "Changed against the record: " + "; ".join(map(latex_prose, report.changes)) if report.changes else ""
    blocks = [changes, latex_prose(balance(report)), *map(_headline, headlines(report))]
    blocks.append(latex_table(("Equations", "How many", "What it means"), rows))
    return [*blocks, latex_table(("Claims", "How many", "What it means"), tried) if tried else ""]


def _headline(headline: Headline) -> str:
    formula = displayed_formula(headline.formula) if headline.formula else ""
    shown = f"Shown in {_links(headline.ids)}." if headline.ids else ""
    return f"{_paragraph(headline.title, headline.text)} {formula} {shown}"


def _verdicts(report: Report) -> list[str]:
    rows = [
        (_link(v.id), latex_prose(report.paper.equation(v.id).title), word(v.verdict), latex_prose(note(v)))
        for v in report.verdicts
    ]
    return [latex_table(("Equation", "Title", "Verdict", "Why, or under what condition"), rows)]


def _equation(verdict: Verdict, report: Report) -> str:
    entry, statement = report.paper.equation(verdict.id), verdict.statement
    lines = map(displayed_formula, derived_lines(statement.relations))
    parts = [
        _heading(verdict.id, f"{entry.title}: {word(verdict.verdict)}", verdict.id),
        rf"\textbf{{As printed.}} {displayed_formula(entry.latex)}",
        rf"\textbf{{{derived_heading(statement.relations)}.}} {' '.join(lines) or 'nothing to derive'}",
        *(_fact(fact) for fact in facts(verdict, report)),
    ]
    return "\n\n".join(filter(None, parts))


def _fact(fact: Fact) -> str:
    words = [*map(latex_prose, fact.texts), _links(fact.ids)]
    words += [f"${latex_inline(letter)}$" for letter in fact.formulas if letter.is_Symbol]
    shown = (displayed_expression(formula) for formula in fact.formulas if not formula.is_Symbol)
    return " ".join([rf"\textbf{{{fact.label}.}}", *filter(None, words), *shown, *map(displayed_formula, fact.sources)])


def _claim(result: Result, report: Report) -> str:
    entry, finding = report.paper.claims[result.test.id], result.finding
    parts = [
        _heading(entry.id, f"{word(finding.outcome)} (section {entry.section})", entry.id),
        rf"\begin{{quote}}{latex_prose(entry.text)}\end{{quote}}",
        latex_prose(finding.explanation),
        rf"\textbf{{If:}} {latex_prose(finding.condition)}" if finding.condition else "",
        *(_fact(fact) for fact in linked_facts(result, report)),
        _numbers(f"Measured ({result.test.model})", ((n.replace("_", " "), v) for n, v in result.measured.items())),
    ]
    return "\n\n".join(filter(None, parts))


def _shown(part: ShownPart, report: Report) -> list[str]:
    drawn = [_picture(picture, report) for picture in part.pictures]
    remarks = [_paragraph(*remark) for remark in part.remarks]
    return [*(_side_by_side(each, report) for each in part.tables), *remarks, *drawn]


def _side_by_side(shown: Table, report: Report) -> str:
    rows = [tuple(_cell(cell, report) for cell in row) for row in shown.rows]
    table = latex_table(tuple(map(latex_prose, shown.head)), rows)
    return f"{_paragraph(shown.title, '')}\n\n{table}\n\n{latex_prose(shown.note)}"


def _cell(cell: Cell, report: Report) -> str:
    if isinstance(cell, tuple):
        return r"\par ".join(_cell(part, report) for part in cell)
    if isinstance(cell, FigureLink):
        drawn = any(picture.key == cell.key for picture in report.pictures)
        return _link(f"figure {cell.key}") if drawn else latex_prose(f"figure {cell.key}")
    return displayed_expression(cell) if isinstance(cell, sp.Basic) else latex_prose(cell)


def _picture(picture: Picture, report: Report) -> str:
    key = f"figure {picture.key}"
    parts = [
        _heading(f"Figure {picture.key}", picture.title, key),
        rf"\drawn{{figures/{picture.png.name}}}",
        latex_prose(picture.caption),
        *(_fact(fact) for fact in figure_facts(picture, report)),
        _numbers("Measured", picture.measured.items()),
    ]
    return "\n\n".join(filter(None, parts))


def _numbers(title: str, measured: Iterable[tuple[str, float]]) -> str:
    rows = [(latex_prose(name), f"{value:.6g}") for name, value in measured]
    return latex_table((latex_prose(title), "Value"), rows) if rows else ""


def _cite(report: Report) -> list[str]:
    sentences, entry = citation()
    return [*map(latex_prose, sentences), f"{{\\scriptsize\\begin{{verbatim}}\n{entry}\n\\end{{verbatim}}}}"]


def _made(report: Report) -> list[str]:
    versions = [(latex_prose(name), latex_prose(number)) for name, number in report.versions]
    inputs = [(latex_prose(name), latex_prose(digest)) for name, digest in report.inputs]
    blocks = [made_beside(latex_prose), latex_table(("What", "Version"), versions) if versions else ""]
    return [*blocks, latex_table(("Input", "SHA-256"), inputs) if inputs else ""]


def _waiting(report: Report) -> list[str]:
    return [latex_table(("Equation", "Title"), [(entry.id, latex_prose(entry.title)) for entry in report.waiting])]


def _paragraph(title: str, text: str) -> str:
    return rf"\textbf{{{latex_prose(title)}.}} {latex_prose(text)}"


def _heading(name: str, title: str, identifier: str) -> str:
    target = rf"\hypertarget{{{anchor(identifier)}}}{{{latex_prose(name)}}}"
    return rf"\subsection*{{{target}\quad {latex_prose(title)}}}"


def _link(identifier: str) -> str:
    return rf"\hyperlink{{{anchor(identifier)}}}{{{latex_prose(identifier)}}}"


def _links(identifiers: Iterable[str]) -> str:
    return ", ".join(map(_link, identifiers))


_PARTS: dict[str, Callable[[Report], list[str]]] = {
    "summary": _summary,
    "verdicts": _verdicts,
    "notation": lambda report: [
        latex_table(
            ("Symbol", "Meaning", "Unit"),
            [
                (f"${latex_inline(s)}$", latex_prose(meaning), latex_prose(unit))
                for s, meaning, unit in notation(report)
            ],
        )
    ],
    "errata": lambda report: [latex_block(e) for e in errata(report.verdicts, report.paper)],
    "claims": lambda report: [_claim(result, report) for result in report.claims],
    "derivations": lambda report: [
        latex_table(
            ("Derivation", "Script"),
            [(latex_prose(name), latex_prose(f"{stem}.py")) for stem, name, _ in report.derivations],
        )
    ],
    "waiting": _waiting,
    "cite": _cite,
    "made": _made,
}
