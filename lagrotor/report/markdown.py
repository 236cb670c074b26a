"""The report as Markdown with LaTeX between dollar signs, as code hosts draw it."""

import re
from collections.abc import Callable, Iterable, Iterator

import sympy as sp

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.papers import Paper
from lagrotor.paper.readable import readable
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
from lagrotor.report.errata import errata
from lagrotor.report.facts import Fact, facts, figure_facts, linked_facts, note
from lagrotor.report.results import balance, headlines, opening


def markdown(report: Report) -> str:
    """The whole report; figures are linked as `figures/<stem>.svg`."""
    listed = contents(report)
    blocks = [
        f"# {report.title}",
        f"{SUBTITLE}.",
        *(f"**{label}** {_prose(text)}" for label, text in opening(report)),
        _prose(report.how_to_read),
        "\n".join(f"- [{heading}](#{name})" for name, heading in listed),
    ]
    for name, heading in listed:
        blocks += [_place(name), f"## {heading}", *_section(name, report)]
    return "\n\n".join(blocks) + "\n"


def _section(name: str, report: Report) -> list[str]:
    if name.startswith("section-"):
        return [_equation(verdict, report) for verdict in report.sections[name.removeprefix("section-")]]
    return list(_PARTS[name](report)) if name in _PARTS else _shown(report.part(name), report)


def _summary(report: Report) -> Iterator[str]:
    if report.changes:
        yield "**Changed against the record:**"
        yield "\n".join(f"- {_prose(change)}" for change in report.changes)
    yield balance(report)
    if fallen := [v.id for v in report.verdicts if v.verdict == "refuted"]:
        yield f"Refuted: {_links(fallen)}"
    for number, headline in enumerate(headlines(report), 1):
        yield f"### {number}. {_prose(headline.title)}"
        yield _prose(headline.text)
        if headline.formula:
            yield _display(headline.formula)
        if headline.ids:
            yield f"Shown in {_links(headline.ids)}"
    yield "### Equations"
    yield "\n".join(f"- {count} {word(answer)}: {MEANINGS[answer]}" for answer, count in report.counts.items())
    if report.claims:
        yield "### Claims"
        tried = report.outcomes.items()
        yield "\n".join(f"- {count} {word(answer)}: {CLAIM_MEANINGS[answer]}" for answer, count in tried)


def _shown(part: ShownPart, report: Report) -> list[str]:
    blocks = [block for table in part.tables for block in _side_by_side(table)]
    blocks += [f"**{_prose(title)}.** {_prose(text)}" for title, text in part.remarks]
    return blocks + [_picture(picture, report) for picture in part.pictures]


def _cite(report: Report) -> list[str]:
    sentences, entry = citation()
    return [*map(_prose, sentences), f"```bibtex\n{entry}\n```"]


def _made(report: Report) -> list[str]:
    return [
        "The same inputs give the same file, byte for byte; how long each part took is in times.json.",
        made_beside(lambda file: f"[{file}]({file})"),
        _rows(("What", "Version"), report.versions),
        _rows(("Input", "SHA-256"), ((name, f"`{digest}`") for name, digest in report.inputs)),
    ]


def _table(report: Report) -> str:
    rows = [
        (_links([v.id]), _prose(report.paper.equation(v.id).title), word(v.verdict), _prose(note(v)))
        for v in report.verdicts
    ]
    return _rows(("Equation", "Title", "Verdict", "Why, or under what condition"), rows)


def _equation(verdict: Verdict, report: Report) -> str:
    entry, statement = report.paper.equation(verdict.id), verdict.statement
    parts = [
        _place(anchor(verdict.id)),
        f"### {verdict.id} {_prose(entry.title)}: {word(verdict.verdict)}",
        "As printed:",
        _display(entry.latex),
    ]
    if derived := derived_lines(statement.relations):
        parts += [f"{derived_heading(statement.relations)}:", *map(_display, derived)]
    parts += [_fact(fact) for fact in facts(verdict, report)]
    return "\n\n".join(parts)


def _fact(fact: Fact) -> str:
    words = [_prose(text) for text in fact.texts] + [_links(fact.ids)]
    words += [f"${latex(letter)}$" for letter in fact.formulas if letter.is_Symbol]
    line = f"**{fact.label}:** " + " ".join(filter(None, words))
    return "\n\n".join(
        [
            line.rstrip(),
            *(_display(latex(formula)) for formula in fact.formulas if not formula.is_Symbol),
            *map(_display, fact.sources),
        ]
    )


def errata_blocks(verdicts: Iterable[Verdict], paper: Paper) -> list[str]:
    """The errata sheet as Markdown blocks, without a heading of its own; none when nothing is refuted."""
    blocks: list[str] = []
    for e in errata(verdicts, paper):
        used = ", ".join(f"[{i}](report.md#{anchor(i)})" for i in e.used_by) or "none"
        blocks += [
            _place(f"erratum-{e.id}"),
            f"### Erratum {e.id}: {_prose(e.title)}",
            _prose(e.wrong),
            "Printed:",
            _display(e.printed),
            f"Correct ({e.verdict_of_correction}):",
            *map(_display, e.corrected),
            *([f"If {_prose('; '.join(e.premises))}.", *map(_display, e.put)] if e.premises else []),
            f"Used by: {used}; {e.reach}.",
        ]
    return blocks


def _claim(result: Result, report: Report) -> str:
    entry, finding = report.paper.claims[result.test.id], result.finding
    parts = [_place(anchor(entry.id)), f"### {entry.id} section {entry.section}: {word(finding.outcome)}"]
    parts += [f"> {_prose(entry.text)}", _prose(finding.explanation)]
    if finding.condition:
        parts.append(f"**If:** {_prose(finding.condition)}")
    parts += map(_fact, linked_facts(result, report))
    rows = [(_prose(name.replace("_", " ")), f"{value:.6g}") for name, value in result.measured.items()]
    return "\n\n".join([*parts, _rows((f"Measured ({_prose(result.test.model)})", "Value"), rows)])


def _side_by_side(table: Table) -> list[str]:
    rows = [tuple(_cell(cell) for cell in row) for row in table.rows]
    return [f"### {_prose(table.title)}", _rows(table.head, rows), *filter(None, [_prose(table.note)])]


def _cell(cell: Cell) -> str:
    if isinstance(cell, tuple):
        return "<br>".join(map(_cell, cell))
    if isinstance(cell, FigureLink):
        return f"[figure {cell.key}](#figure-{cell.key})"
    if isinstance(cell, sp.Basic):  # a bar would end the cell
        return "$" + latex(cell).replace(r"\left|", r"\left\lvert ").replace(r"\right|", r"\right\rvert ") + "$"
    return _prose(cell)


def _picture(picture: Picture, report: Report) -> str:
    image = f"![{_prose(picture.alt)}](figures/{picture.svg.name})"
    heading = f"### Figure {picture.key}: {_prose(picture.title)}"
    parts = [_place(f"figure-{picture.key}"), heading, image, _prose(picture.caption)]
    parts += map(_fact, figure_facts(picture, report))
    if picture.measured:
        parts.append(_rows(("Measured", "Value"), [(_prose(n), f"{v:.6g}") for n, v in picture.measured.items()]))
    return "\n\n".join(parts)


def _rows(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _display(source: str) -> str:
    return f"$$\n{source}\n$$"


def _place(name: str) -> str:
    return f'<a id="{name}"></a>'


def _links(identifiers: Iterable[str]) -> str:
    return ", ".join(f"[{identifier}](#{anchor(identifier)})" for identifier in identifiers)


def _prose(text: str) -> str:
    """Text on one line in which nothing is read as Markdown, HTML or a table's edge."""
    return re.sub(r"([\\`*_\[\]<>|#$~])", r"\\\1", " ".join(readable(text).split()))


_PARTS: dict[str, Callable[[Report], Iterable[str]]] = {
    "summary": _summary,
    "verdicts": lambda report: [_table(report)],
    "notation": lambda report: [
        _rows(
            ("Symbol", "Meaning", "Unit"),
            [(f"${latex(s)}$", _prose(meaning), unit) for s, meaning, unit in notation(report)],
        )
    ],
    "errata": lambda report: errata_blocks(report.verdicts, report.paper),
    "model": lambda report: ["Sliders and both tips in motion, in a browser: [index.html](index.html#model)."],
    "claims": lambda report: [_claim(result, report) for result in report.claims],
    "derivations": lambda report: [
        "\n".join(f"- [{_prose(name)}](pages/derivation-{stem}.html)" for stem, name, _ in report.derivations)
    ],
    "waiting": lambda report: [_rows(("Equation", "Title"), [(e.id, _prose(e.title)) for e in report.waiting])],
    "cite": _cite,
    "made": _made,
}
