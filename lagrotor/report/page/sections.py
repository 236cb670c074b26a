"""The sections of the report as HTML, and their entries: equations, errata, claims, figures and main results.

Their links lead to anchors of the report and to files beside its front page.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from html import escape

from lagrotor.paper.catalogue import Equation
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.latex.readings import typeset_lines
from lagrotor.paper.verdicts import Verdict
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import (
    BESIDE,
    CLAIM_MEANINGS,
    MEANINGS,
    Report,
    ResultSection,
    anchor,
    as_read,
    citation,
    contents,
    derived_heading,
    derived_lines,
    notation,
)
from lagrotor.report.errata import Erratum, errata, premise_formulas
from lagrotor.report.facts import Headline, balance, facts, figure_facts, headlines, linked_facts, note, opening, unmet
from lagrotor.report.page.html_elements import (
    badge,
    code,
    fact_list,
    file_link,
    fold,
    heading,
    html_table,
    inline,
    link,
    link_to_derivation,
    links,
    number_list,
    prose,
    side_by_side,
    size,
    typeset,
)

# Characters of MathML beyond which the derived form is placed below the printed one.
_WIDEST = 2_000


def equation_entry(verdict: Verdict, report: Report) -> str:
    """Return the HTML entry of an equation: as printed beside as derived, the facts about it, and its LaTeX source."""
    entry, statement = report.paper.equation(verdict.id), verdict.statement
    printed = typeset(entry.latex)
    derived = (
        "".join(map(typeset, derived_lines(statement.relations)))
        or "<p>This is a definition and needs no derivation.</p>"
    )
    read = code("\n".join(as_read(entry)))
    how = f"<p>The print is read as follows: {prose(entry.reading)}.</p>" if entry.reading else ""
    how += reading_of(entry, report)
    source = code(entry.latex) + how + (f"<p>As sympy reads it:</p>{read}" if entry.line else "")
    number = f" <small>({entry.number} in the paper)</small>" if entry.number else ""
    proof = report.certificates.get(verdict.id)
    certificate = f"<p>Coq certificate: {file_link(proof)}</p>" if proof else ""
    return (
        f'<article id="{anchor(verdict.id)}">{heading(anchor(verdict.id), verdict.id, entry.title, verdict.verdict)}'
        f"{_beside(f'As printed{number}', printed, derived_heading(statement.relations), derived)}"
        f"{fact_list(facts(verdict, report))}"
        f"{certificate}{link_to_derivation(verdict.id, report)}{fold('LaTeX source and reading', source, 'source')}</article>"
    )


def reading_of(entry: Equation, report: Report) -> str:
    """Return as HTML how the LaTeX of an equation was read, and whether the author has confirmed it.

    The text is empty for an equation without LaTeX.
    """
    if not entry.read:
        return ""
    lines = "".join(map(typeset, typeset_lines(report.paper, entry.id)))
    return f"<p>Its reading, {'confirmed' if entry.is_confirmed else 'not confirmed'}:</p>{lines}"


def erratum_entry(e: Erratum) -> str:
    """Return the HTML entry of an erratum: printed and corrected equation, the error, and its effect on results."""
    correct = "".join(map(typeset, e.corrected))
    for label, premises in e.conditions:
        formulas = "".join(map(typeset, premise_formulas(premises)))
        correct += f"<p>{label}: {prose('; '.join(p.sentence for p in premises))}.</p>{formulas}"
    return (
        f'<article id="erratum-{e.id}">{heading(f"erratum-{e.id}", e.id, e.title)}<p>{prose(e.wrong)}</p>'
        f"{_beside('Printed', typeset(e.printed), f'Corrected equation ({escape(e.verdict_of_correction)})', correct)}"
        f"<p><small>{escape(e.reach.capitalize())}. Derived in {link(e.id)}. Used by: {links(e.used_by) or 'none'}"
        "</small></p></article>"
    )


def _beside(heading_a: str, printed: str, heading_b: str, derived: str) -> str:
    """Return two formulas side by side under their headings; they stand below each other if one is wide."""
    layout = "pair" if max(len(printed), len(derived)) < _WIDEST else "stack"
    return (
        f'<div class="{layout}"><div><h4>{heading_a}</h4>{printed}</div><div><h4>{heading_b}</h4>{derived}</div></div>'
    )


def claim_entry(result: Result, report: Report) -> str:
    """Return the HTML entry of a claim: the paper's words, its outcome with reasons, and the measured numbers."""
    entry, finding = report.paper.claims[result.test.id], result.finding
    condition = f"<p><b>Condition:</b> {prose(finding.condition)}</p>" if finding.condition else ""
    place = anchor(entry.id)
    return (
        f'<article id="{place}">{heading(place, entry.id, f"section {entry.section}", finding.outcome)}'
        f"<blockquote><p>{prose(entry.text)}</p></blockquote><p>{prose(finding.explanation)}</p>{condition}"
        f"{fact_list(linked_facts(result, report))}"
        f"{fold(f'Measured ({result.test.model})', number_list('Quantity', result.measured.items()))}</article>"
    )


def picture_entry(picture: Picture, report: Report) -> str:
    """Return the HTML entry of a figure: the drawing, its caption, its equations and claims, and measured numbers."""
    place = anchor(f"figure {picture.key}")
    measured = fold("Measured", number_list("Quantity", picture.measured.items())) if picture.measured else ""
    return (
        f'<figure id="{place}">{heading(place, f"Figure {picture.key}", picture.title)}'
        f"{_image(picture)}"
        f"<figcaption>{prose(picture.caption)}</figcaption>{fact_list(figure_facts(picture, report))}{measured}</figure>"
    )


def _image(picture: Picture) -> str:
    """Return the HTML element of a drawing. It is loaded when it is scrolled to, and a click enlarges it (page.js)."""
    width, height = size(picture)
    source = f'src="figures/{picture.svg.name}" width="{width}" height="{height}"'
    return f'<img {source} loading="lazy" alt="{escape(picture.alt)}">'


_MOST = 3  # drawings above a derivation; others are linked only
_NAMED = re.compile(r"\bfigures? ([a-z]?\d+)\b", re.IGNORECASE)
_TREATED = re.compile(r'class="judged">[^<]*<a href="#([^"]+)"')


def derivation_figures(stem: str, inside: str, report: Report) -> str:
    """Return the figures that belong to a derivation as HTML; the page of the derivation contains `inside`.

    They are the figure of the same name (t5_floquet), those of the equations and claims that it treats, and those that its
    text names.
    """
    treated, name = set(_TREATED.findall(inside)), stem.partition("_")[2]
    keys = set(_NAMED.findall(inside))
    keys |= {str(n) for n, figure in report.paper.figures.items() if treated & set(map(anchor, figure.equations))}
    keys |= {key for claim in report.paper.claims.values() if anchor(claim.id) in treated for key in claim.figures}
    pictures = [p for p in report.pictures if p.key in keys or p.stem.partition("_")[2] == name]
    drawn = "".join(
        f"<figure>{_image(p)}<figcaption>{links([f'figure {p.key}'])}{prose(p.title)}</figcaption></figure>"
        for p in pictures[:_MOST]
    )
    others = links(f"figure {p.key}" for p in pictures[_MOST:])
    return (f'<div class="figures">{drawn}</div>' if drawn else "") + (f"<p>See also {others}</p>" if others else "")


def headline_entry(headline: Headline, report: Report) -> str:
    """Return the HTML entry of a main result: title, sentence, formula, figure and links."""
    formula = typeset(headline.formula) if headline.formula else ""
    drawn = next((p for p in report.pictures if f"figure {p.key}" == headline.figure), None)
    formula += _image(drawn) if drawn else ""
    links_to = f"<p>Shown in {links(headline.ids)}</p>" if headline.ids else ""
    return f"<li><h3>{prose(headline.title)}</h3><p>{prose(headline.text)}</p>{formula}{links_to}</li>"


def count_entry(answer: str, count: int, meaning: str) -> str:
    """Return the HTML entry that states how many equations or claims have an answer, and what this answer means."""
    return f"<li><b>{count}</b> {badge(answer)} <span>{escape(meaning)}</span></li>"


@dataclass(frozen=True)
class Section:
    """A section of the report: its anchor, heading and HTML."""

    anchor: str
    heading: str
    inside: str

    @property
    def html(self) -> str:
        """The section as HTML; the interactive model has its own heading."""
        if self.anchor == "model":
            return self.inside
        heading = f'<h2 id="{self.anchor}">{escape(self.heading)}</h2>'
        return f'<section aria-labelledby="{self.anchor}">{heading}\n{self.inside}</section>'


def sections(report: Report) -> list[Section]:
    """Return every section of the report, in the order of the table of contents."""
    return [Section(anchor, heading, _inside(anchor, report)) for anchor, heading in contents(report)]


def introduction(report: Report) -> str:
    """Return the opening lines of `paper.toml` as an HTML list, which stands above the sections; "" without any."""
    lines = "".join(f"<li><b>{escape(label)}</b> {prose(text)}</li>" for label, text in opening(report))
    return f'<ul class="opening">{lines}</ul>' if lines else ""


def _inside(anchor: str, report: Report) -> str:
    if anchor == "model":
        return report.model
    if anchor.startswith("section-"):
        verdicts = report.sections[anchor.removeprefix("section-")]
        return "\n".join(equation_entry(verdict, report) for verdict in verdicts)
    return _PARTS[anchor](report) if anchor in _PARTS else _result_section(report.result_section(anchor), report)


def _summary(report: Report) -> str:
    equations = "".join(count_entry(answer, count, MEANINGS[answer]) for answer, count in report.counts.items())
    outcomes = "".join(count_entry(answer, count, CLAIM_MEANINGS[answer]) for answer, count in report.outcomes.items())
    refuted = links(v.id for v in report.verdicts if v.verdict == "refuted")
    balanced = f"<p>{escape(balance(report))}</p>" + (f"<p>Refuted: {refuted}</p>" if refuted else "")
    results = "".join(headline_entry(headline, report) for headline in headlines(report))
    results = f'<ol class="results">{results}</ol>' if results else ""
    changed = "".join(f"<li>{escape(change)}</li>" for change in report.changes)
    warning = (
        f'<div class="changed"><p>Verdicts that differ from the record:</p><ul>{changed}</ul></div>' if changed else ""
    )
    claims = f'<h3>Claims</h3><ul class="summary">{outcomes}</ul>' if outcomes else ""
    how = f"<p>{escape(report.how_to_read)}</p>"
    return f'{warning}{balanced}{results}<h3>Equations</h3><ul class="summary">{equations}</ul>{claims}{how}'


def _verdicts(report: Report) -> str:
    lines = [
        (link(v.id), prose(report.paper.equation(v.id).title), badge(v.verdict), f"<small>{prose(note(v))}</small>")
        for v in report.verdicts
    ]
    above = f"<p>{prose(text)}</p>" if (text := unmet(report)) else ""
    return above + html_table(("Equation", "Title", "Verdict", "Reason or condition"), lines, "verdicts")


def _notation(report: Report) -> str:
    lines = [(inline(symbol), prose(meaning), escape(unit)) for symbol, meaning, unit in notation(report)]
    head, first = ("Symbol", "Meaning", "Unit"), len(report.paper.about.letters) or len(lines)
    remainder = fold("All other symbols", html_table(head, lines[first:])) if lines[first:] else ""
    return html_table(head, lines[:first]) + remainder


def _derivations(report: Report) -> str:
    how = "<p>Unfold an entry to read the derivation. The run that wrote this page decided each of its equations exactly, or "
    how += 'through the order shown. The symbols are listed in the <a href="#notation">notation</a>.</p>'
    return how + "\n".join(
        f'<details class="derivation" id="derivation-{stem}"><summary>{prose(name)}</summary>{inside}</details>'
        for stem, name, inside in report.derivations
    )


def _result_section(section: ResultSection, report: Report) -> str:
    blocks = [side_by_side(table, report) for table in section.tables]
    blocks += [f"<h3>{prose(title)}</h3><p>{prose(text)}</p>" for title, text in section.remarks]
    blocks += [picture_entry(picture, report) for picture in section.pictures]
    return "\n".join(blocks)


def _waiting(report: Report) -> str:
    if not any(entry.read for entry in report.waiting):
        return html_table(("Equation", "Title"), [(entry.id, prose(entry.title)) for entry in report.waiting])
    rows = [(e.id, prose(e.title), typeset(e.latex), reading_of(e, report)) for e in report.waiting]
    return html_table(("Equation", "Title", "As printed", "As read"), rows)


def _cite(report: Report) -> str:
    sentences, entry = citation()
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in sentences) + code(entry)


def _made(report: Report) -> str:
    versions = html_table(("Software", "Version"), [(escape(name), escape(number)) for name, number in report.versions])
    files = html_table(
        ("File in the same folder", "Content"), [(file_link(file), what) for file, what in BESIDE.items()]
    )
    inputs = [(escape(name), f"<code>{escape(digest)}</code>") for name, digest in report.inputs]
    return (
        "<p>The same inputs give the same page, byte for byte. The computing times are in times.json.</p>"
        f"{files}{versions}{html_table(('Input', 'SHA-256'), inputs)}"
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
