"""The errata sheet: each refuted equation as printed and corrected, the error, and its effect on the paper's results."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from lagrotor.mechanics.glossary import GREEK, latex
from lagrotor.paper.audit import uncorrected
from lagrotor.paper.catalogue import section_meanings
from lagrotor.paper.papers import Paper
from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import AGREES, Relation, Verdict
from lagrotor.report.latex import END, head, latex_prose, latex_table, tidy

# Verdict of a correction → its words in the sheet.
_CORRECTED = {
    "holds": "holds exactly",
    "holds-if": "holds under the premises",
    "holds-to-order": "holds to the order shown",
}


@dataclass(frozen=True)
class Erratum:
    """One refuted equation.

    cited: its place in the paper. printed, corrected: its LaTeX as printed, and the corrected lines. wrong: the error in
    words. verdict_of_correction: the verdict on the correction in words. used_by: ids of the equations that use it.
    survives: True if no result of the paper depends on the error. section: that whose letters it uses.
    conditions: premises, each list with a label that says whether the error or the correction needs them.
    """

    id: str
    cited: str
    title: str
    printed: str
    corrected: tuple[str, ...]
    wrong: str
    verdict_of_correction: str
    used_by: tuple[str, ...]
    survives: bool
    section: str = ""
    conditions: tuple[tuple[str, tuple[Premise, ...]], ...] = ()

    @property
    def reach(self) -> str:
        """The effect of the error on the paper's results, in words."""
        if self.survives:
            return "no result of the paper depends on this error"
        return "this error changes a result of the paper"


def errata(verdicts: Iterable[Verdict], paper: Paper) -> Iterator[Erratum]:
    """Yield an erratum for each refuted equation of an audit, in the order of the verdicts."""
    listed = list(verdicts)
    for verdict in listed:
        if verdict.verdict == "refuted":
            statement, entry = verdict.statement, paper.equation(verdict.id)
            yield Erratum(
                id=entry.id,
                cited=entry.cited,
                title=entry.title,
                printed=entry.latex,
                corrected=correction_lines(verdict),
                conditions=tuple(_conditions(verdict)),
                wrong=statement.wrong,
                verdict_of_correction=_CORRECTED.get(verdict.correction_verdict or "", "as derived"),
                used_by=tuple(v.id for v in listed if entry.id in v.statement.depends_on),
                survives=not verdict.reaches_result,
                section=entry.section,
            )


def _conditions(verdict: Verdict) -> Iterator[tuple[str, tuple[Premise, ...]]]:
    """Yield rows (label, premises): one for the error and one for its correction.

    They become one row if the error has all premises of the correction; a row without premises is left out.
    """
    premises, required = verdict.refuted_under, verdict.premises
    rows = [("Premises of the error", premises), ("Premises of the correction", required)]
    if required and all(premise in premises for premise in required):
        rows = [("Premises of error and correction", premises)]
    yield from (row for row in rows if row[1])


def premise_formulas(premises: Iterable[Premise]) -> tuple[str, ...]:
    """Return the equations of the premises in LaTeX, one line for each premise that has equations.

    An equation between components is left out: the sentence of such a premise already states the equation of the vectors.
    """
    return tuple(r",\quad ".join(p.tex) for p in premises if p.tex and not _in_components(p))


def correction_lines(verdict: Verdict) -> tuple[str, ...]:
    """Return the corrected lines of an equation in LaTeX.

    These are the stated corrections that hold, and the derived lines for which no correction is stated.
    """
    right = (line.relation for line in verdict.correction_lines if line.verdict in AGREES)
    lines = [_line(relation, relation.printed) for relation in right]
    return tuple(dict.fromkeys([*lines, *(_line(relation, relation.derived) for relation in uncorrected(verdict))]))


def _line(relation: Relation, side: Any) -> str:
    """Return quantity = expression, with the O() of a series."""
    quantity = f"{relation.quantity} = " if relation.quantity else ""
    if relation.written:
        return f"{quantity}{relation.written}"
    small, order = relation.known or (relation.small, relation.claimed)
    return f"{quantity}{latex(side)}" + (rf" + O({latex(small ** (order + 1))})" if small is not None else "")


LETTER_HEAD = ("Letter", "Meaning", "Unit", "In")
LETTERS_FIRST = (
    "The table explains the letters of the corrections and premises. A dot over a letter, or a prime after it, denotes its time "
    "derivative. The last column lists the items in which a letter has this meaning."
)
PREMISES_CITED = "The premises, which the items cite as P1, P2, …:"


def sheet_summary(verdicts: Iterable[Verdict], errors: list[Erratum]) -> Iterator[str]:
    """Yield the paragraphs above the items of the sheet: what it is, and how many errors change a result."""
    yield (
        "This sheet lists the equations of the paper that differ from what the same premises give, each as printed and as it "
        "should read. Every equation was derived anew, and one exact procedure compared both forms with the derivation."
        + "".join(
            f" The number of an item, such as {e.id}, is that of the report, not of a section; a number that the paper prints at "
            "the equation follows in parentheses."
            for e in errors[:1]
        )
    )
    differ = "1 differs" if len(errors) == 1 else f"{len(errors)} differ"
    reaching = [e.id for e in errors if not e.survives]
    others = len(errors) - len(reaching)
    effect = f"{len(reaching)} of the errors change a result of the paper ({', '.join(reaching)})" if reaching else ""
    rest = f"no result depends on the {'other ' if reaching else ''}{others}" if others else ""
    counted = f"Of {len(list(verdicts))} equations of the paper {differ} from the derivation."
    yield f"{counted} {'; '.join(filter(None, [effect, rest]))}." if errors else counted


# LaTeX that names no quantity, and a letter with its accent and its index.
_NO_LETTER = re.compile(r"\\text\{[^}]*\}|\\frac\{d\}\{dt\}|\\d?dot\b|\\(?:left|right)\b|\^\{?T\b|\bO *(?=\\left|\()")
_LETTER = re.compile(r"(?:\\(vec|hat)\s*\{?\s*)?(\\[A-Za-z]+|[A-Za-z])\}?(?:_(\{[^{}]*\}|\w))?")
_COMPONENT = re.compile(r"(?:_|\d|dot)[xyz]$")


def letters_in(tex: str) -> tuple[str, ...]:
    r"""Return the letters of a formula without dots, as "vec X_r": accent, letter and index."""
    found = _LETTER.findall(_NO_LETTER.sub(" ", tex))
    named = (
        " ".join(filter(None, (mark, letter))) + f"_{index.strip('{}')}".rstrip("_")
        for mark, letter, index in found
        if not letter.startswith("\\") or letter in GREEK.values()
    )
    return tuple(dict.fromkeys(named))


def letter_table(errors: Iterable[Erratum], paper: Paper) -> list[tuple[str, str, str, str]]:
    """Return (LaTeX, meaning, unit, ids) of the letters in the corrections and in the formulas of the premises.

    A letter that has two meanings has two rows. A letter that the paper does not explain has none.
    """
    rows: dict[tuple[str, str, str], tuple[str, list[str]]] = {}  # (letter, meaning, unit) → LaTeX, ids
    for e in errors:
        known = {
            letters_in(tex): (tex, *row) for tex, row in section_meanings(paper, e.section).items() if "dot{" not in tex
        }
        premises = (p for _, listed in e.conditions for p in listed)
        for letter in dict.fromkeys(c for tex in (*e.corrected, *premise_formulas(premises)) for c in letters_in(tex)):
            if (letter,) in known:
                tex, meaning, unit = known[letter,]
                ids = rows.setdefault((letter, meaning, unit), (tex, []))[1]
                ids += [e.id] if e.id not in ids else []
    return [(tex, meaning, unit, ", ".join(ids)) for (_, meaning, unit), (tex, ids) in rows.items()]


def listed_premises(errors: Iterable[Erratum]) -> list[Premise]:
    """Return each premise of the errors and of their corrections once; its place plus 1 is its number in the sheet."""
    premises = [premise for e in errors for _, assumptions in e.conditions for premise in assumptions]
    return [premise for i, premise in enumerate(premises) if premise not in premises[:i]]


def premise_text(premise: Premise) -> str:
    """Return a premise in words; its formula follows if the words contain none and it is not in components of vectors."""
    return premise.sentence if "=" in premise.says or _in_components(premise) else premise.with_formula


def _in_components(premise: Premise) -> bool:
    return any(_COMPONENT.search(str(left)) for left, _ in premise.equations)


def cited_premises(premises: Iterable[Premise], listed: list[Premise]) -> str:
    """Return the numbers of premises in the list of the sheet, "P1, P3"."""
    return ", ".join(f"P{listed.index(premise) + 1}" for premise in premises)


def latex_document(verdicts: Iterable[Verdict], paper: Paper) -> str:
    """Return the errata sheet as a LaTeX document in ASCII, which needs amsmath, graphicx and hyperref."""
    listed = list(verdicts)
    errors = list(errata(listed, paper))
    title = rf"\section*{{Errata to \emph{{{latex_prose(paper.title)}}}}}"
    above = [latex_prose(sentence) + r"\par" for sentence in sheet_summary(listed, errors)]
    if rows := letter_table(errors, paper):
        cells = [(f"${tidy(tex)}$", *map(latex_prose, texts)) for tex, *texts in rows]
        above += [latex_prose(LETTERS_FIRST) + r"\par", latex_table(LETTER_HEAD, cells)]
    if premises := listed_premises(errors):
        above.append(latex_prose(PREMISES_CITED) + r"\par")
    above += [rf"P{n}: {latex_prose(premise_text(premise))}.\par" for n, premise in enumerate(premises, 1)]
    items = "\n".join(latex_item(e, premises) for e in errors) or rf"\item {latex_prose('None.')}"
    # Small type, without extra space between the items.
    sheet = [r"{\footnotesize\setlength{\parskip}{0pt}\raggedright", *above, r"\begin{enumerate}\itemsep 2pt", items]
    return "\n".join([head(f"Errata to {paper.title}", paper.about.preamble) + title, *sheet, r"\end{enumerate}}", END])


def latex_item(e: Erratum, listed: list[Premise]) -> str:
    """Return one erratum as an item of the LaTeX list; it cites a premise by its number in the list `listed`."""
    reach = "" if e.survives else " This error changes a result of the paper."
    right = r";\quad ".join(line.strip() for line in e.corrected)
    granted = "".join(f" {label}: {cited_premises(conditions, listed)}." for label, conditions in e.conditions)
    return (
        rf"\item \textbf{{{latex_prose(f'{e.id}: {e.cited}')}}}, {latex_prose(e.title)}. {latex_prose(e.wrong)}{reach}{granted}\\"
        rf"Printed: ${tidy(e.printed)}$\\ Should read: ${tidy(right)}$"
    )
