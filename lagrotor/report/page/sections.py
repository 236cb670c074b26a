"""The sections of the report as HTML, and their entries: equations, errata, claims, figures and main results.

Their links lead to anchors of the report and to files beside its front page.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from html import escape

from lagrotor.paper.catalogue import Equation
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.latex.readings import typeset_lines
from lagrotor.paper.premises import Premise
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
    claim_title,
    contents,
    derived_heading,
    derived_lines,
    notation,
)
from lagrotor.report.errata import (
    LETTER_HEAD,
    LETTERS_FIRST,
    PREMISES_CITED,
    Erratum,
    cited_premises,
    errata,
    letter_table,
    listed_premises,
    premise_text,
    sheet_summary,
)
from lagrotor.report.facts import Headline, balance, facts, figure_facts, headlines, linked_facts, note, opening, unmet
from lagrotor.report.page.html_elements import (
    badge,
    code,
    fact_list,
    file_link,
    fold,
    foldable,
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
    """Return the HTML entry of an equation: its printed and derived form side by side, facts about it, and its LaTeX source."""
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
    inside = (
        f"{_beside(f'As printed{number}', printed, derived_heading(statement.relations), derived)}"
        f"{fact_list(facts(verdict, report))}"
        f"{certificate}{link_to_derivation(verdict.id, report)}{fold('LaTeX source and reading', source, 'source')}"
    )
    return _entry(anchor(verdict.id), heading(verdict.id, entry.title, verdict.verdict), inside)


def _entry(place: str, title: str, inside: str) -> str:
    return f'<article id="{place}">{foldable(title, inside)}</article>'


def reading_of(entry: Equation, report: Report) -> str:
    """Return as HTML how the LaTeX of an equation was read, and whether the author has confirmed it.

    The text is empty for an equation without LaTeX.
    """
    if not entry.read:
        return ""
    lines = "".join(map(typeset, typeset_lines(report.paper, entry.id)))
    return f"<p>Its reading, {'confirmed' if entry.is_confirmed else 'not confirmed'}:</p>{lines}"


def errata_sheet(report: Report) -> str:
    """Return the HTML of the errata sheet: what it is, the table of letters, the numbered premises, and the errata."""
    errors = list(errata(report.verdicts, report.paper))
    listed = listed_premises(errors)
    above = "".join(f"<p>{prose(sentence)}</p>" for sentence in sheet_summary(report.verdicts, errors))
    rows = [
        (prose(f"${tex}$"), prose(meaning), prose(unit).replace(" ", "&nbsp;"), ids)
        for tex, meaning, unit, ids in letter_table(errors, report.paper)
    ]
    if rows:
        above += foldable("<h3>Letters</h3>", f"<p>{prose(LETTERS_FIRST)}</p>{html_table(LETTER_HEAD, rows)}")
    premises = "".join(
        f'<li id="premise-{n}"><b>P{n}:</b> {prose(premise_text(premise))}.</li>' for n, premise in enumerate(listed, 1)
    )
    if premises:
        above += foldable("<h3>Premises</h3>", f'<p>{prose(PREMISES_CITED)}</p><ul class="premises">{premises}</ul>')
    return above + "\n".join(erratum_entry(e, listed) for e in errors)


def erratum_entry(e: Erratum, listed: list[Premise]) -> str:
    """Return the HTML entry of an erratum; its premises are links to their place in the list `listed` of the sheet."""
    place = f"erratum-{e.id}"
    correct = "".join(map(typeset, e.corrected))
    for label, premises in e.conditions:
        cited = re.sub(r"P(\d+)", r'<a href="#premise-\1">P\1</a>', cited_premises(premises, listed))
        correct += f"<p>{label}: {cited}.</p>"
    inside = (
        f"<p><b>{prose(e.cited.capitalize())}.</b> {prose(e.wrong)}</p>"
        f"{_beside('Printed', typeset(e.printed), f'Corrected equation ({escape(e.verdict_of_correction)})', correct)}"
        f"<p><small>{escape(e.reach.capitalize())}. Derived in {link(e.id)}. Used by: {links(e.used_by) or 'none'}</small></p>"
    )
    return _entry(place, heading(e.id, e.title), inside)


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
    inside = (
        f"<blockquote><p>{prose(entry.text)}</p></blockquote><p>{prose(finding.explanation)}</p>{condition}"
        f"{fact_list(linked_facts(result, report))}"
        f"{fold(f'Measured ({result.test.model})', number_list('Quantity', result.measured.items()))}"
    )
    return _entry(place, heading(entry.id, claim_title(entry), finding.outcome), inside)


def picture_entry(picture: Picture, report: Report) -> str:
    """Return the HTML entry of a figure: the drawing, its caption, its equations and claims, and measured numbers."""
    place = anchor(f"figure {picture.key}")
    measured = fold("Measured", number_list("Quantity", picture.measured.items())) if picture.measured else ""
    drawn = f"<figure>{_image(picture)}<figcaption>{prose(picture.caption)}</figcaption></figure>"
    inside = f"{drawn}{fact_list(figure_facts(picture, report))}{measured}"
    return _entry(place, heading(f"Figure {picture.key}", picture.title), inside)


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
        return f'<section aria-labelledby="{self.anchor}">{self._title}\n{self.inside}</section>'

    @property
    def folded(self) -> str:
        """The section as HTML that page.js folds on a narrow screen, except the model and the main results."""
        if self.anchor in ("model", "summary"):
            return self.html
        return f'<section aria-labelledby="{self.anchor}">{foldable(self._title, self.inside)}</section>'

    @property
    def _title(self) -> str:
        return f'<h2 id="{self.anchor}">{escape(self.heading)}</h2>'


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
        above = _overview((v.id, report.paper.equation(v.id).title, v.verdict) for v in verdicts)
        return above + "\n".join(equation_entry(verdict, report) for verdict in verdicts)
    return _PARTS[anchor](report) if anchor in _PARTS else _result_section(report.result_section(anchor), report)


def _overview(entries: Iterable[tuple[str, str, str]]) -> str:
    """Return a list of links to entries, (id, title, verdict), for a wide screen; a narrow one shows folded entries."""
    lines = (
        f'<li>{link(identifier)} {prose(title)}<span class="unseen">,</span> {badge(answer)}</li>'
        for identifier, title, answer in entries
    )
    return f'<ul class="overview">{"".join(lines)}</ul>'


def _claims(report: Report) -> str:
    rows = ((r.test.id, claim_title(report.paper.claims[r.test.id]), r.finding.outcome) for r in report.claims)
    return _overview(rows) + "\n".join(claim_entry(result, report) for result in report.claims)


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
    "errata": errata_sheet,
    "claims": _claims,
    "derivations": _derivations,
    "waiting": _waiting,
    "cite": _cite,
    "made": _made,
}
