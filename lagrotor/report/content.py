"""The contents of a report and their order, independent of the output format."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from textwrap import shorten

import sympy as sp

from lagrotor.mechanics.glossary import latex
from lagrotor.paper import scripts
from lagrotor.paper.audit import NOT_YET
from lagrotor.paper.catalogue import Claim, Equation, is_claim
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.papers import Paper
from lagrotor.paper.plain_text import from_latex
from lagrotor.paper.tables import Table
from lagrotor.paper.verdicts import Relation, Verdict
from lagrotor.pictures.figures import Picture

SUBTITLE = "Every equation as printed and as derived, with its verdict"
# File of the report's folder → its content.
BESIDE = {
    "index.html": "this report, as pages",
    "whole.html": "this report, as one self-contained page",
    "report.md": "this report, as Markdown",
    "report.tex": "this report, as LaTeX",
    "errata.md": "the errata only",
    "verdicts.json": "the verdicts as data",
    "claims.json": "the claims as data",
    "measured.json": "the numbers read from the figures",
}

MEANINGS = {
    "holds": "the printed expression equals the derived one; this is decided exactly",
    "holds-if": "the two expressions are equal under the stated condition",
    "holds-to-order": "the two expressions agree up to and including the stated order",
    "refuted": "the two expressions differ; the same procedure decides whether the correction holds",
    "proved": "a theorem encloses the exact value in an interval, and all of it rounds to the printed number",
    "measured": "the paper read this number from a simulation; the derived value rounds to it",
    "definition": "the line only introduces a name",
    "undecided": "the exact procedure cannot decide the equation; numerical evidence is given",
    NOT_YET: "no derivation treats this equation yet",
}
CLAIM_MEANINGS = {
    "proved": "every part of the claim follows from a theorem",
    "confirmed": "simulations agree with the claim; their errors are estimated, not proved",
    "confirmed-if": "the claim holds under the stated condition",
    "refuted": "a simulation or a theorem contradicts the claim",
}


@dataclass(frozen=True)
class ResultSection:
    """A section of the report besides equations and claims.

    tables: its tables. remarks: findings, each as (title, text). pictures: its figures.
    """

    name: str
    heading: str
    tables: tuple[Table, ...] = ()
    remarks: tuple[tuple[str, str], ...] = ()
    pictures: tuple[Picture, ...] = ()


@dataclass(frozen=True)
class Report:
    """All results of one run on a paper.

    verdicts: those on the judged equations. pictures: the drawn figures. changes: a sentence for each verdict that differs
    from the recorded one. claims: the results of the tested claims. derivations: (stem, title, HTML) of each derivation.
    model: the HTML of the interactive model, "" without one. versions: (software, version). inputs: (input, SHA-256).
    certificates: id of an equation → its Coq file in the report's folder.
    """

    paper: Paper
    verdicts: tuple[Verdict, ...]
    pictures: tuple[Picture, ...]
    changes: tuple[str, ...]
    claims: tuple[Result, ...] = ()
    result_sections: tuple[ResultSection, ...] = ()
    derivations: tuple[tuple[str, str, str], ...] = ()
    model: str = ""
    versions: tuple[tuple[str, str], ...] = ()
    inputs: tuple[tuple[str, str], ...] = ()
    certificates: Mapping[str, str] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """The title of the report, which contains the paper's."""
        return f'A re-examination of "{self.paper.title}"'

    @property
    def how_to_read(self) -> str:
        """The introduction of the report: how equations, claims and figures were examined, and how they are cited."""
        equations, claims = list(self.paper.equations)[:1], list(self.paper.claims)[:1]
        text = "Each equation of the paper is read as printed and derived anew; an exact decision procedure compares the two. "
        if claims:
            text += "Each claim made in words is tested by a simulation or a theorem. A printed number agrees with a computed "
            text += "one that rounds to it: 16 stands for 15.5 to 16.5, and 11.4 for 11.35 to 11.45. "
        text += "Each figure is drawn again. " if self.paper.figures else ""
        text += "All numbers were computed by the run that wrote this page, except computing times, which are on record with the "
        ids = [
            *(f"Equations are cited by numbers of this report, such as {i}" for i in equations),
            *(f"claims as {i}" for i in claims),
        ]
        return f"{text}machine. {', and '.join(ids)}."

    @property
    def waiting(self) -> list[Equation]:
        """The equations of the paper that no derivation treats yet."""
        judged = {verdict.id for verdict in self.verdicts}
        return [entry for entry in self.paper.equations.values() if entry.id not in judged]

    @property
    def sections(self) -> dict[str, list[Verdict]]:
        """A map from each section of the paper to the verdicts on its equations."""
        verdicts_of: dict[str, list[Verdict]] = {}
        for verdict in self.verdicts:
            verdicts_of.setdefault(self.paper.equation(verdict.id).section, []).append(verdict)
        return verdicts_of

    @property
    def counts(self) -> dict[str, int]:
        """The number of equations with each verdict that occurs, in the order of `MEANINGS`."""
        counted: Counter[str] = Counter(verdict.verdict for verdict in self.verdicts)
        counted[NOT_YET] = len(self.waiting)
        return {answer: counted[answer] for answer in MEANINGS if counted[answer]}

    @property
    def outcomes(self) -> dict[str, int]:
        """The number of claims with each outcome that occurs, in the order of `CLAIM_MEANINGS`."""
        counted: Counter[str] = Counter(result.finding.outcome for result in self.claims)
        return {answer: counted[answer] for answer in CLAIM_MEANINGS if counted[answer]}

    def result_section(self, name: str) -> ResultSection:
        """Return the section of the report that has this name, such as "figures"."""
        return next(section for section in self.result_sections if section.name == name)

    def users(self, identifier: str) -> tuple[str, ...]:
        """Return the ids of the equations that use this equation."""
        return tuple(v.id for v in self.verdicts if identifier in v.statement.depends_on)

    def claims_about(self, identifier: str) -> tuple[str, ...]:
        """Return the ids of the tested claims about this equation."""
        return tuple(r.test.id for r in self.claims if identifier in self.paper.claims[r.test.id].equations)

    def figures_of(self, identifier: str) -> tuple[str, ...]:
        """Return the drawn figures that show this equation, such as "figure 19"."""
        numbers = {str(number) for number, entry in self.paper.figures.items() if identifier in entry.equations}
        return tuple(f"figure {picture.key}" for picture in self.pictures if picture.key in numbers)


def anchor(identifier: str) -> str:
    """Return the HTML anchor of an equation ("5.07"), a claim ("C08") or a figure ("figure 19")."""
    if identifier.startswith("figure "):
        return identifier.replace(" ", "-")
    return f"claim-{identifier}" if is_claim(identifier) else f"eq-{identifier}"


def contents(report: Report) -> list[tuple[str, str]]:
    """Return the anchor and the heading of each section of a report, in their order; empty sections are left out."""
    paper = [(f"section-{name}", f"{name} {report.paper.about.sections[name]}", True) for name in report.sections]
    listed = [
        ("model", "The pair in motion", bool(report.model)),
        ("summary", "In short", True),
        ("verdicts", "Verdicts", True),
        ("notation", "Notation", bool(report.paper.glossary)),
        ("errata", "Errata", any(v.verdict == "refuted" for v in report.verdicts)),
        *paper,
        ("claims", "Claims", bool(report.claims)),
        ("derivations", "Derivations", bool(report.derivations)),
        *((section.name, section.heading, True) for section in report.result_sections),
        ("waiting", "Not yet judged", bool(report.waiting)),
        ("cite", "How to cite", True),
        ("made", "How this was made", True),
    ]
    return [(name, heading) for name, heading, is_filled in listed if is_filled]


def notation(report: Report) -> list[tuple[sp.Symbol, str, str]]:
    """Return each symbol of the paper with its meaning and its unit.

    The symbols listed under `letters` in `paper.toml` come first; time derivatives are left out.
    """
    first = report.paper.about.letters
    entries = [entry for symbol, entry in report.paper.glossary.items() if not symbol.name.endswith("dot")]
    entries.sort(key=lambda entry: first.index(entry.symbol.name) if entry.symbol.name in first else len(first))
    return [(entry.symbol, entry.meaning, entry.unit) for entry in entries]


def word(answer: str) -> str:
    """Return a verdict or an outcome in words: "holds if" for "holds-if"."""
    return answer.replace("-", " ")


def claim_title(claim: Claim) -> str:
    """Return the title of a claim, the beginning of its text and its section."""
    return f"{shorten(claim.text, 72, placeholder=' …')} (section {claim.section})"


def count_list(counts: dict[str, int]) -> str:
    """Return the number of each verdict or outcome in words, such as "9 confirmed, 3 refuted"."""
    return ", ".join(f"{count} {word(answer)}" for answer, count in counts.items())


def derived_lines(relations: Iterable[Relation]) -> tuple[str, ...]:
    """Return the derived lines of an equation in LaTeX, quantity = expression, each only once."""
    lines = (f"{r.quantity} = {r.written or latex(r.derived)}" for r in relations)
    return tuple(dict.fromkeys(line.removeprefix(" = ") for line in lines))


def derived_heading(relations: Iterable[Relation]) -> str:
    """Return the heading of the derived lines; it says whether premises are substituted in them."""
    return "As derived, under the premises" if any(r.granted for r in relations) else "As derived"


def as_read(entry: Equation) -> tuple[str, ...]:
    """Return each printed line as sympy reads it, in the form quantity = member = …."""
    return tuple(" = ".join([from_latex(row["quantity"]), *row.get("members", ())]) for row in entry.line)


def citation() -> tuple[list[str], str]:
    """Return two things: the sentences on how to cite lagrotor, one for each reference, and a BibTeX entry."""
    head, _, listed = scripts.beside("CITATION.cff").read_text(encoding="utf-8").partition("references:")
    field = dict(re.findall(r"^(\w+): *(.+)$", head, re.MULTILINE))
    title, authors = field["title"].strip('"'), " and ".join(_names(head))
    sentences = [field["message"]]
    for block in re.split(r"^  - type: ", listed, flags=re.MULTILINE)[1:]:
        work, year = re.search(r"title: *(.+)", block), re.search(r"year: *(\d+)", block)
        if work:
            what = work[1].strip('"') + (f", {year[1]}" if year else "")
            sentences.append(f"{', '.join(_names(block))}: {what}.")
    entry = f"@software{{lagrotor,\n  author = {{{{{authors}}}}},\n  title = {{{{{title}}}}},\n"
    return sentences, f"{entry}  version = {{{field['version']}}},\n  license = {{{field['license']}}}\n}}"


def _names(block: str) -> list[str]:
    """Return the authors that a block of CITATION.cff lists, each with the first name before the family name."""
    whole = re.findall(r"^ +- name: *(.+)$", block, re.MULTILINE)
    persons = re.findall(r"family-names: *(.+)\n +given-names: *(.+)", block)
    return [*whole, *(f"{first_name} {family}" for family, first_name in persons)]
