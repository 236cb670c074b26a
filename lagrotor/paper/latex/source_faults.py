r"""What TeX would stop at, where the source itself has it."""

import re

from lagrotor.paper.latex.expansion import STYLES, Expander
from lagrotor.paper.latex.tokens import latex_of

# In another environment, of a class or package that is not beside the source, LaTeX may be shown and not set.
SET = (
    "document equation align gather multline eqnarray flalign alignat displaymath math subequations split aligned gathered"
    " alignedat cases array matrix pmatrix bmatrix vmatrix Vmatrix Bmatrix smallmatrix itemize enumerate description figure"
    " table tabular tabularx longtable minipage center flushleft flushright quote quotation abstract proof frame"
    " thebibliography"
)
_SHOWN_SOURCE = re.compile(
    r"(?<!\\)%[^\n]*|\\begin\s*\{([^{}\n]+)\}|\\(?!left|right|middle|[bB]ig)[A-Za-z]+\*?(?:\[[^]\n]*\])?"
    r"(?:\|[^|\n]*\||\{[^{}\n\\]*%[^{}\n]*\})"
)


def faults_of(expander: Expander) -> list[tuple[str, int, str]]:
    """File and line of what TeX would stop at, where the source itself has it: of a macro's parts too little is known."""
    macros = expander.macros
    macros.close_to(len(macros.groups) if expander.level is None else expander.level, say=False)
    open_braces = next((n for n, (mark, _) in enumerate(macros.groups) if mark != "{"), len(macros.groups))
    macros.close_to(open_braces)
    for _, at in macros.groups:  # TeX ends, and warns
        expander.notes.append("{}:{}: {{ is not closed".format(*expander.line(at)))
    macros.close_to(0, say=False)
    made, shown = [], dict[int, list[tuple[int, int]]]()
    for at, mark, said in sorted(macros.faults):
        start, name, _, text = expander.file_of(at)
        if at < 0 or name.endswith(STYLES) or not _stands(expander, mark, text, at - start):
            continue
        if start not in shown:
            shown[start] = _shown_source(expander, text)
        if not any(first <= at - start < last for first, last in shown[start]):
            made.append((*expander.line(at), said))
    return list(dict.fromkeys(made))


def _stands(expander: Expander, mark: str, text: str, at: int) -> bool:
    r"""Whether a mark stands at a place of the text, \begin{…} by a macro too that is nothing else."""
    if not mark.startswith(r"\begin"):
        return text.startswith(mark, at)
    word = re.compile(r"\\begin\s*\{[^{}]*\}|\\[A-Za-z@]+").match(text, at)
    macro = expander.macros.get(word[0]) if word else None
    return bool(word) and (latex_of(macro.body) if macro else "".join(word[0].split())).strip() == mark  # type: ignore[index]


def _shown_source(expander: Expander, text: str) -> list[tuple[int, int]]:
    r"""Where a file may show LaTeX that is not set: environments that nothing defines, \code|…|."""
    spans, place = [], 0
    while (span := _SHOWN_SOURCE.search(text, place)) is not None:
        place = span.end()
        if (name := span[1]) is not None:
            known = name.rstrip("*") in SET.split() or name in expander.environments or name in expander.theorems
            end = -1 if known or rf"\{name}" in expander.macros else text.find(rf"\end{{{name}}}", place)
            place = max(place, end)
            if end < 0:
                continue
        if not span[0].startswith("%"):
            spans.append((span.start(), place + 1))
    return spans
