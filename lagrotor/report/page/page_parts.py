"""The entries of the page: an equation, an erratum, a claim, a figure, a result."""

from html import escape

from lagrotor.paper.catalogue import Equation
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.latex.readings import typeset_lines
from lagrotor.paper.verdicts import Verdict
from lagrotor.pictures.figures import Picture
from lagrotor.report.content import Report, anchor, as_read, derived_heading, derived_lines
from lagrotor.report.errata import Erratum, premise_formulas
from lagrotor.report.facts import facts, figure_facts, linked_facts
from lagrotor.report.page.derivation_pages import link_to_derivation
from lagrotor.report.page.embed import size
from lagrotor.report.page.page_pieces import (
    badge,
    code,
    fact_list,
    file_link,
    fold,
    heading,
    link,
    links,
    number_list,
    prose,
    typeset,
)
from lagrotor.report.results import Headline

# Characters of MathML beyond which the derived form is placed below the printed one, not beside it.
_WIDEST = 2_000


def equation_entry(verdict: Verdict, report: Report) -> str:
    """As printed beside as derived; what is said of it; folds with the source and the steps."""
    entry, statement = report.paper.equation(verdict.id), verdict.statement
    printed = typeset(entry.latex)
    derived = "".join(map(typeset, derived_lines(statement.relations))) or "<p>A definition: nothing to derive.</p>"
    read = code("\n".join(as_read(entry)))
    how = f"<p>How it was read: {prose(entry.reading)}.</p>" if entry.reading else ""
    how += reading_of(entry, report)
    source = code(entry.latex) + how + (f"<p>As sympy reads it:</p>{read}" if entry.line else "")
    number = f" <small>(the paper's {entry.number})</small>" if entry.number else ""
    proof = report.certificates.get(verdict.id)
    certificate = f"<p>Certificate, for Coq: {file_link(proof)}</p>" if proof else ""
    return (
        f'<article id="{anchor(verdict.id)}">{heading(anchor(verdict.id), verdict.id, entry.title, verdict.verdict)}'
        f"{_beside(f'As printed{number}', printed, derived_heading(statement.relations), derived)}"
        f"{fact_list(facts(verdict, report))}"
        f"{certificate}{link_to_derivation(verdict.id, report)}{fold('LaTeX, and how it was read', source, 'source')}</article>"
    )


def reading_of(entry: Equation, report: Report) -> str:
    """Return the reading of an equation of a source, typeset, and whether it is confirmed; nothing for other lines."""
    if not entry.read:
        return ""
    lines = "".join(map(typeset, typeset_lines(report.paper, entry.id)))
    return f"<p>Its reading, {'confirmed' if entry.is_confirmed else 'not confirmed'}:</p>{lines}"


def erratum_entry(e: Erratum) -> str:
    """Printed, correct, what was wrong, how far it reaches."""
    correct = "".join(map(typeset, e.corrected))
    for label, premises in e.conditions:
        put = "".join(map(typeset, premise_formulas(premises)))
        correct += f"<p>{label} {prose('; '.join(p.sentence for p in premises))}.</p>{put}"
    return (
        f'<article id="erratum-{e.id}">{heading(f"erratum-{e.id}", e.id, e.title)}<p>{prose(e.wrong)}</p>'
        f"{_beside('Printed', typeset(e.printed), f'Correct ({escape(e.verdict_of_correction)})', correct)}"
        f"<p><small>{escape(e.reach.capitalize())}. Derived in {link(e.id)}. Used by: {links(e.used_by) or 'none'}"
        "</small></p></article>"
    )


def _beside(left: str, printed: str, right: str, derived: str) -> str:
    """Two formulas under their headings, one below the other where either is wide."""
    layout = "pair" if max(len(printed), len(derived)) < _WIDEST else "stack"
    return f'<div class="{layout}"><div><h4>{left}</h4>{printed}</div><div><h4>{right}</h4>{derived}</div></div>'


def claim_entry(result: Result, report: Report) -> str:
    """The claim in the paper's words, its outcome, what was measured."""
    entry, finding = report.paper.claims[result.test.id], result.finding
    condition = f"<p><b>If:</b> {prose(finding.condition)}</p>" if finding.condition else ""
    place = anchor(entry.id)
    return (
        f'<article id="{place}">{heading(place, entry.id, f"section {entry.section}", finding.outcome)}'
        f"<blockquote><p>{prose(entry.text)}</p></blockquote><p>{prose(finding.explanation)}</p>{condition}"
        f"{fact_list(linked_facts(result, report))}"
        f"{fold(f'Measured ({result.test.model})', number_list('What', result.measured.items()))}</article>"
    )


def picture_entry(picture: Picture, report: Report) -> str:
    """The figure with its caption, what it belongs to, and the numbers read off it."""
    place = anchor(f"figure {picture.key}")
    measured = fold("Measured", number_list("What", picture.measured.items())) if picture.measured else ""
    return (
        f'<figure id="{place}">{heading(place, f"Figure {picture.key}", picture.title)}'
        f"{_image(picture)}"
        f"<figcaption>{prose(picture.caption)}</figcaption>{fact_list(figure_facts(picture, report))}{measured}</figure>"
    )


def _image(picture: Picture) -> str:
    """The drawing alone, loaded when it is come to; a click opens it large (page.js)."""
    width, height = size(picture)
    source = f'src="figures/{picture.svg.name}" width="{width}" height="{height}"'
    return f'<img {source} loading="lazy" alt="{escape(picture.alt)}">'


def headline_entry(headline: Headline, report: Report) -> str:
    """One of the results that matter, with its figure."""
    formula = typeset(headline.formula) if headline.formula else ""
    drawn = next((p for p in report.pictures if f"figure {p.key}" == headline.figure), None)
    formula += _image(drawn) if drawn else ""
    shown = f"<p>Shown in {links(headline.ids)}</p>" if headline.ids else ""
    return f"<li><h3>{prose(headline.title)}</h3><p>{prose(headline.text)}</p>{formula}{shown}</li>"


def count_entry(answer: str, count: int, meaning: str) -> str:
    """How often a verdict was given, and what it means."""
    return f"<li><b>{count}</b> {badge(answer)} <span>{escape(meaning)}</span></li>"
