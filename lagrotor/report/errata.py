"""The errata sheet: for each refuted equation what is printed, what is right, what was wrong, and how far it reaches."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from lagrotor.mechanics.glossary import latex
from lagrotor.paper.ledger import Relation, Statement, Verdict
from lagrotor.paper.papers import Paper
from lagrotor.report.latex import END, head, printed, prose


@dataclass(frozen=True)
class Erratum:
    """One row: printed and corrected in LaTeX, `wrong` in a line, ids that use it, and whether a result falls with it."""

    id: str
    title: str
    printed: str
    corrected: tuple[str, ...]
    wrong: str
    verdict_of_correction: str
    used_by: tuple[str, ...]
    survives: bool

    @property
    def reach(self) -> str:
        """What becomes of the paper's results, in words."""
        if self.survives:
            return "no result of the paper depends on this error"
        return "a result of the paper that depends on it, or is it, is refuted too"


def errata(verdicts: Iterable[Verdict], paper: Paper) -> Iterator[Erratum]:
    """The refuted equations of an audit, in its order."""
    listed = list(verdicts)
    for verdict in listed:
        if verdict.verdict == "refuted":
            statement, entry = verdict.statement, paper.equation(verdict.id)
            yield Erratum(
                id=entry.id,
                title=entry.title,
                printed=entry.latex,
                corrected=corrected(statement),
                wrong=statement.wrong,
                verdict_of_correction=(verdict.correction_verdict or "undecided").replace("-", " "),
                used_by=tuple(v.id for v in listed if entry.id in v.statement.depends_on),
                survives=not verdict.reaches_result,
            )


def corrected(statement: Statement) -> tuple[str, ...]:
    """The correction of an equation in LaTeX, a line for each of its relations."""
    return tuple(_line(relation.quantity, relation) for relation in statement.correction)


def _line(quantity: str, relation: Relation) -> str:
    """quantity = expression, up to a power of what is small where the correction is a series."""
    if relation.written:
        return f"{quantity} = {relation.written}"
    rest = rf" + O({latex(relation.small ** (relation.claimed + 1))})" if relation.small else ""
    return (f"{quantity} = " if quantity else "") + f"{latex(relation.printed)}{rest}"


def latex_document(verdicts: Iterable[Verdict], paper: Paper) -> str:
    """The sheet as a LaTeX document in ASCII that compiles with amsmath, graphicx and hyperref."""
    title = rf"\section*{{Errata to \emph{{{prose(paper.title)}}}}}"
    return "\n".join([head(f"Errata to {paper.title}") + title, *map(latex_block, errata(verdicts, paper)), END])


def latex_block(e: Erratum) -> str:
    """One row as a LaTeX subsection."""
    used = ", ".join(e.used_by) or "none"
    return "\n\n".join(
        [
            rf"\subsection*{{{e.id}\quad {prose(e.title)}}}",
            rf"\textbf{{Printed.}} {printed(e.printed)}",
            rf"\textbf{{Correct}} ({e.verdict_of_correction}). " + " ".join(map(printed, e.corrected)),
            rf"\textbf{{What was wrong.}} {prose(e.wrong)}",
            rf"Used by: {used}. {prose(e.reach).capitalize()}.",
        ]
    )
