"""The sections of the report as HTML, links to places of the report and to files beside its front page."""

from collections.abc import Callable
from dataclasses import dataclass
from html import escape

from lagrotor.report.cite import citation
from lagrotor.report.content import (
    BESIDE,
    CLAIM_MEANINGS,
    MEANINGS,
    Report,
    ShownPart,
    contents,
    notation,
)
from lagrotor.report.errata import errata
from lagrotor.report.facts import note
from lagrotor.report.page.page_parts import (
    claim_entry,
    count_entry,
    equation_entry,
    erratum_entry,
    headline_entry,
    picture_entry,
    reading_of,
)
from lagrotor.report.page.page_pieces import (
    badge,
    code,
    file_link,
    fold,
    html_table,
    inline,
    link,
    links,
    prose,
    side_by_side,
    typeset,
)
from lagrotor.report.results import balance, headlines, opening


@dataclass(frozen=True)
class Section:
    """A part of the report under its heading: where it is, its heading, HTML."""

    anchor: str
    heading: str
    inside: str

    @property
    def html(self) -> str:
        """The section; the live model brings its own."""
        if self.anchor == "model":
            return self.inside
        heading = f'<h2 id="{self.anchor}">{escape(self.heading)}</h2>'
        return f'<section aria-labelledby="{self.anchor}">{heading}\n{self.inside}</section>'


def sections(report: Report) -> list[Section]:
    """Every section of the report, in the order of its contents."""
    return [Section(anchor, heading, _inside(anchor, report)) for anchor, heading in contents(report)]


def introduction(report: Report) -> str:
    """What stands above the sections: three lines of what is right and wrong, where the paper has them."""
    lines = "".join(f"<li><b>{escape(label)}</b> {prose(text)}</li>" for label, text in opening(report))
    return f'<ul class="opening">{lines}</ul>' if lines else ""


def _inside(anchor: str, report: Report) -> str:
    if anchor == "model":
        return report.model
    if anchor.startswith("section-"):
        verdicts = report.sections[anchor.removeprefix("section-")]
        return "\n".join(equation_entry(verdict, report) for verdict in verdicts)
    return _PARTS[anchor](report) if anchor in _PARTS else _shown(report.part(anchor), report)


def _summary(report: Report) -> str:
    equations = "".join(count_entry(answer, count, MEANINGS[answer]) for answer, count in report.counts.items())
    tried = "".join(count_entry(answer, count, CLAIM_MEANINGS[answer]) for answer, count in report.outcomes.items())
    fallen = links(v.id for v in report.verdicts if v.verdict == "refuted")
    balanced = f"<p>{escape(balance(report))}</p>" + (f"<p>Refuted: {fallen}</p>" if fallen else "")
    results = "".join(headline_entry(headline, report) for headline in headlines(report))
    results = f'<ol class="results">{results}</ol>' if results else ""
    changed = "".join(f"<li>{escape(change)}</li>" for change in report.changes)
    warning = f'<div class="changed"><p>Changed against the record:</p><ul>{changed}</ul></div>' if changed else ""
    claims = f'<h3>Claims</h3><ul class="summary">{tried}</ul>' if tried else ""
    how = f"<p>{escape(report.how_to_read)}</p>"
    return f'{warning}{balanced}{results}<h3>Equations</h3><ul class="summary">{equations}</ul>{claims}{how}'


def _verdicts(report: Report) -> str:
    lines = [
        (link(v.id), prose(report.paper.equation(v.id).title), badge(v.verdict), f"<small>{prose(note(v))}</small>")
        for v in report.verdicts
    ]
    return html_table(("Equation", "Title", "Verdict", "Why, or under what condition"), lines, "verdicts")


def _notation(report: Report) -> str:
    lines = [(inline(symbol), prose(meaning), escape(unit)) for symbol, meaning, unit in notation(report)]
    head, first = ("Symbol", "Meaning", "Unit"), len(report.paper.about.letters) or len(lines)
    rest = fold("All other letters", html_table(head, lines[first:])) if lines[first:] else ""
    return html_table(head, lines[:first]) + rest


def _derivations(report: Report) -> str:
    how = "<p>Each derivation opens. The run that wrote this page decided each of its equations exactly, or through the order "
    how += "that it shows; letters as in the "
    how += '<a href="#notation">notation</a>.</p>'
    return how + "\n".join(
        f'<details class="derivation" id="derivation-{stem}"><summary>{prose(name)}</summary>{inside}</details>'
        for stem, name, inside in report.derivations
    )


def _shown(part: ShownPart, report: Report) -> str:
    """Tables, what was found, figures."""
    parts = [side_by_side(table, report) for table in part.tables]
    parts += [f"<h3>{prose(title)}</h3><p>{prose(text)}</p>" for title, text in part.remarks]
    parts += [picture_entry(picture, report) for picture in part.pictures]
    return "\n".join(parts)


def _waiting(report: Report) -> str:
    if not any(entry.read for entry in report.waiting):
        return html_table(("Equation", "Title"), [(entry.id, prose(entry.title)) for entry in report.waiting])
    rows = [(e.id, prose(e.title), typeset(e.latex), reading_of(e, report)) for e in report.waiting]
    return html_table(("Equation", "Title", "As printed", "As read"), rows)


def _cite(report: Report) -> str:
    sentences, entry = citation()
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in sentences) + code(entry)


def _made(report: Report) -> str:
    versions = html_table(("What", "Version"), [(escape(name), escape(number)) for name, number in report.versions])
    beside = html_table(
        ("In the same folder", "What it is"), [(file_link(file), what) for file, what in BESIDE.items()]
    )
    inputs = [(escape(name), f"<code>{escape(digest)}</code>") for name, digest in report.inputs]
    return (
        "<p>The same inputs give the same page, byte for byte; how long each part took is in times.json.</p>"
        f"{beside}{versions}{html_table(('Input', 'SHA-256'), inputs)}"
    )


_PARTS: dict[str, Callable[[Report], str]] = {
    "summary": _summary,
    "verdicts": _verdicts,
    "notation": _notation,
    "errata": lambda report: "\n".join(map(erratum_entry, errata(report.verdicts, report.paper))),
    "claims": lambda report: "\n".join(claim_entry(result, report) for result in report.claims),
    "derivations": _derivations,
    "waiting": _waiting,
    "cite": _cite,
    "made": _made,
}
