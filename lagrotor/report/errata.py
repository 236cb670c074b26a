"""The errata sheet: for each refuted equation what is printed, what is right, what was wrong, and how far it reaches."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import sympy as sp

from ..paper.catalogue import equation
from ..paper.ledger import Relation, Verdict
from ..symbols import latex


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
            return "every result of the paper that rests on it stands"
        return "a result of the paper that rests on it, or is it, is refuted too"


def errata(verdicts: Iterable[Verdict]) -> Iterator[Erratum]:
    """The refuted equations of an audit, in its order."""
    listed = list(verdicts)
    for verdict in listed:
        if verdict.verdict == "refuted":
            statement, entry = verdict.statement, equation(verdict.id)
            yield Erratum(
                id=entry.id,
                title=entry.title,
                printed=entry.latex,
                corrected=tuple(map(_line, statement.quantities, statement.correction)),
                wrong=statement.wrong,
                verdict_of_correction=(verdict.correction_verdict or "undecided").replace("-", " "),
                used_by=tuple(v.id for v in listed if entry.id in v.statement.depends_on),
                survives=not verdict.reaches_result,
            )


def _line(quantity: str, relation: Relation) -> str:
    """quantity = expression, up to a power of what is small where the correction is a series.

    Of a vector the quantity is the whole equation; its components were judged and stand in the JSON.
    """
    if isinstance(relation.printed, sp.MatrixBase):
        return quantity
    rest = rf" + O({latex(relation.small ** (relation.claimed + 1))})" if relation.small else ""
    return f"{quantity} = {latex(relation.printed)}{rest}"


_HEAD = r"""\documentclass[11pt]{article}
\usepackage[a4paper,margin=22mm]{geometry}
\usepackage{amsmath,amssymb,graphicx}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
% A formula wider than the line is shrunk to it.
\newsavebox{\formula}
\newcommand{\fit}[1]{\savebox{\formula}{$\displaystyle #1$}%
  \ifdim\wd\formula>\linewidth\resizebox{\linewidth}{!}{\usebox{\formula}}\else\usebox{\formula}\fi}
\begin{document}
\section*{Errata to \emph{Dynamics of Axially Coupled Rotor Pairs}}
"""


def latex_document(verdicts: Iterable[Verdict]) -> str:
    """The sheet as a LaTeX document in ASCII that compiles with amsmath and graphicx."""
    blocks = [_HEAD]
    for e in errata(verdicts):
        corrected = "\n\n".join(rf"\fit{{{part}}}" for part in e.corrected)
        used = ", ".join(e.used_by) or "none"
        blocks.append(
            rf"\subsection*{{{e.id}\quad {prose(e.title)}}}" + "\n"
            rf"\textbf{{Printed.}}\par\fit{{{_formula(e.printed)}}}" + "\n\n"
            rf"\textbf{{Correct}} ({e.verdict_of_correction}).\par {_ascii(corrected)}" + "\n\n"
            rf"\textbf{{What was wrong.}} {prose(e.wrong)}" + "\n\n"
            rf"Used by: {used}. {prose(e.reach).capitalize()}." + "\n"
        )
    return "\n".join([*blocks, r"\end{document}", ""])


_LETTERS = {
    "−": "$-$", "–": "--", "²": "$^2$", "³": "$^3$", "⁴": "$^4$", "·": r"$\cdot$", "±": r"$\pm$", "∓": r"$\mp$",
    "×": r"$\times$", "θ": r"$\theta$", "Ω": r"$\Omega$", "→": r"$\to$", "≠": r"$\neq$", "…": r"\ldots{}", "°": r"$^\circ$",
}  # fmt: skip


def prose(text: str) -> str:
    """Plain text for LaTeX: special characters escaped, signs outside ASCII as mathematics."""
    escaped = re.sub(r"([&%$#_{}])", r"\\\1", text.replace("\\", "/")).replace("^", r"\^{}").replace("~", r"\~{}")
    return "".join(_LETTERS.get(character, character) for character in escaped)


def _formula(source: str) -> str:
    """A printed formula for one line: the source's last comma or full stop belongs to its sentence."""
    return _ascii(re.sub(r"[.,;]\s*$", "", source.strip()))


def _ascii(source: str) -> str:
    return "".join(_LETTERS.get(character, character).strip("$") for character in source)
