r"""Environments that no file defines and that hold a formula: a display of a class that is not beside the source."""

import re
from collections import defaultdict

from lagrotor.paper.latex.expansion import Expander
from lagrotor.paper.latex.source_faults import SET

# What is drawn, computed or set in columns by packages holds =, _ and ^ that are no formula.
_NO_FORMULA = re.compile(
    "tikz|pgf|pic|circ|axis|plot|scope|diagram|chart|graph|tree|forest|feyn|quant|xy|CD|tab|array|code|listing|lst|verb|minted"
    "|algo|prog|print|script|python|julia|matlab|sage|asy|output|console|shell|filecontents|alltt|bib|overlay|animate",
    re.IGNORECASE,
)
_GROUP = r"\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}"
_WITHIN = r"aligned|alignedat|gathered|split|cases|[bpvBV]?matrix|smallmatrix|array"  # of a formula
_LEFT_OUT = [
    re.compile(pattern, re.DOTALL)
    for pattern in (
        r"(?<!\\)%[^\n]*",
        rf"^\\(?:begin\s*\{{[^{{}}]*\}}|[A-Za-z@]+)(?:\s*(?:\[[^]]*\]|{_GROUP}))*",
        rf"\\begin\{{(?!(?:{_WITHIN})\}})([^{{}}]*)\}}.*?\\end\{{\1\}}",
        r"\\(?:text\w*|[mh]box|label|\w*ref|\w*cite\w*|include\w*|input|url|href|[hv]space|\w*caption\w*|footnote\w*|set\w*|item)"
        rf"(?![A-Za-z])\*?(?:\s*(?:\[[^]]*\]|<[^>]*>|{_GROUP}))*",
        rf"(?<=\\mathrm)\s*{_GROUP}|(?<=\\operatorname)\s*{_GROUP}|(?<=[_^]){_GROUP}|\\[A-Za-z]+\*?\[[^]\n]*\]",
    )
]
_FORMULA = re.compile(
    rf"(?<![A-Za-z\\][A-Za-z])(?<!\\)[_^]|\\begin\{{(?:{_WITHIN})\}}|\\(?:[dt]?frac|sqrt|partial|nabla|o?int|sum|prod|left|cdot|times"
    r"|leq?|geq?|neq|approx|equiv|simeq?|propto|infty|[dh]ot|ddot|vec|bar|math[a-z]+|[Aa]lpha|beta|[Gg]amma|[Dd]elta|epsilon|eta"
    r"|[Tt]heta|[Ll]ambda|mu|nu|[Pp]i|rho|[Ss]igma|tau|[Pp]hi|varphi|[Pp]si|[Oo]mega)(?![A-Za-z])"
)
# Words, formulas among words, and code.
_TEXT = re.compile(
    r"(?<!\\)\$|\\[\[(]|(?<!\\)\b[^\W\d_]{3,}[,.;:]?\s+[^\W\d_]{2,}|#|==|::|\(\)|;\s*$|[\u3040-\u9fff]{2}", re.MULTILINE
)
_NO_SIGNS = re.compile(r"(?<!\\)\b[^\W\d_]{3,}|[;\"'@{}]")


class UnknownEnvironments:
    """Those that a source has, as it is walked through; `notes` says of each once what is passed over."""

    def __init__(self, expander: Expander) -> None:
        self.expander = expander
        self.begun: dict[str, int] = {}  # name → where the last one began
        self.places: defaultdict[str, list[int]] = defaultdict(list)

    def begin(self, name: str, at: int) -> None:
        """One begins that is no display."""
        if not (name in SET.split() or name in self.expander.theorems or _NO_FORMULA.search(name)):
            self.begun[name] = at

    def end(self, name: str, at: int) -> None:
        """One ends: whether it held a formula is known by its text."""
        first = self.begun.pop(name, None)
        if first is None or (file := self.expander.file_of(first)) != self.expander.file_of(at):
            return
        if _holds_formula(file[3][first - file[0] : at - file[0]]):
            self.places[name].append(first)

    def notes(self) -> list[str]:
        """File and line of the first of each name, how many more there are, and what would help."""
        files = " and ".join(f"{file}, loaded in line {line}," for file, line in self.expander.missing.items())
        said = []
        for name, (first, *more) in self.places.items():
            rest = f", as {'is' if len(more) == 1 else 'are'} {len(more)} more of this name" if more else ""
            helps = f"write equation, or define it by \\newenvironment{{{name}}}"
            if files:
                helps = f"put {files} beside the source, which may define it, or {helps}"
            place = "{}:{}".format(*self.expander.line(first))
            said.append(rf"{place}: \begin{{{name}}} is not known, and its formula is passed over{rest}: {helps}")
        return said


def _holds_formula(text: str) -> bool:
    """Whether the text of an environment is a formula by itself, outside $ … $ and other displays, and no prose or code."""
    for pattern in _LEFT_OUT:
        text = pattern.sub(" ", text)
    if _TEXT.search(text):
        return False
    return bool(_FORMULA.search(text) or ("=" in text and not _NO_SIGNS.search(text)))
