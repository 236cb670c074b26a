"""The errata sheet: each refuted equation as printed and corrected, the error, and its effect on the paper's results."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.audit import uncorrected
from lagrotor.paper.papers import Paper
from lagrotor.paper.premises import Premise
from lagrotor.paper.verdicts import AGREES, Relation, Verdict
from lagrotor.report.latex import END, head, latex_prose, tidy

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
    survives: True if no result of the paper depends on the error. letters: names of the symbols in the correction.
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
    letters: frozenset[str] = frozenset()
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
                letters=frozenset(s.name for r in statement.correction for s in r.printed.free_symbols),
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
    """Return the equations of the premises in LaTeX, one line for each premise that has equations."""
    return tuple(r",\quad ".join(premise.tex) for premise in premises if premise.tex)


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


def latex_document(verdicts: Iterable[Verdict], paper: Paper) -> str:
    """Return the errata sheet as a LaTeX document in ASCII, which needs amsmath, graphicx and hyperref."""
    listed = list(verdicts)
    errors = list(errata(listed, paper))
    title = rf"\section*{{Errata to \emph{{{latex_prose(paper.title)}}}}}"
    summary = " ".join(latex_prose(text) for text in _summary(listed, errors, paper))
    premises = [premise for e in errors for _, assumptions in e.conditions for premise in assumptions]
    assumed = [premise for i, premise in enumerate(premises) if premise not in premises[:i]]
    if assumed:
        named = [p.sentence if "=" in p.says else p.with_formula for p in assumed]
        summary += " Premises: " + "; ".join(f"({n}) {latex_prose(text)}" for n, text in enumerate(named, 1)) + "."
    items = "\n".join(latex_item(e, assumed) for e in errors) or rf"\item {latex_prose('None.')}"
    # Small type, without extra space between the items.
    sheet = [r"{\footnotesize\setlength{\parskip}{0pt}\raggedright", summary, r"\begin{enumerate}\itemsep 2pt", items]
    return "\n".join([head(f"Errata to {paper.title}", paper.about.preamble) + title, *sheet, r"\end{enumerate}}", END])


def _summary(verdicts: list[Verdict], errors: list[Erratum], paper: Paper) -> Iterator[str]:
    """Yield the sentences above the items of the sheet."""
    differ = "1 differs" if len(errors) == 1 else f"{len(errors)} differ"
    yield (
        f"{len(verdicts)} equations were read as printed and derived anew; {differ} from the derivation. Each differing equation "
        "is listed by its number or section, as printed and as it should read. One exact procedure decided the printed as well "
        "as the corrected equations."
    )
    used = {letter for e in errors for letter in e.letters}
    meanings = {entry.symbol.name: entry.meaning for entry in paper.glossary.values()}
    letters = "; ".join(
        f"{name} is {meanings[name]}" for name in paper.about.letters if name in used and name in meanings
    )
    if letters:
        yield f"Symbols in the corrections: {letters}."
    if reaching := sum(not e.survives for e in errors):
        yield f"{reaching} of the errors change a result of the paper; no result depends on the other {len(errors) - reaching}."


def latex_item(e: Erratum, listed: list[Premise]) -> str:
    """Return one erratum as an item of the LaTeX list; it cites a premise by its number in the list `listed`."""
    reach = "" if e.survives else " This error changes a result of the paper."
    right = r";\quad ".join(line.strip() for line in e.corrected)
    granted = "".join(
        f" {label}: {', '.join(f'({listed.index(p) + 1})' for p in conditions)}." for label, conditions in e.conditions
    )
    return (
        rf"\item \textbf{{{latex_prose(e.cited.capitalize())}}}, {latex_prose(e.title)}. {latex_prose(e.wrong)}{reach}{granted}\\"
        rf"Printed: ${tidy(e.printed)}$\\ Should read: ${tidy(right)}$"
    )
