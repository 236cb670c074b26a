"""Elements of the report's LaTeX files: the head, text and formulas in ASCII, tables, and breaks in long formulas."""

import re
import unicodedata
from collections.abc import Iterable

import sympy as sp

from lagrotor.mechanics.glossary import GREEK, latex
from lagrotor.paper.latex.headings import ACCENTS
from lagrotor.paper.latex.tokens import tokenize
from lagrotor.paper.plain_text import readable

_HEAD = r"""\documentclass[11pt]{article}
\usepackage[a4paper,margin=22mm]{geometry}
\usepackage{amsmath,amssymb,graphicx,array,longtable}
\usepackage[hidelinks]{hyperref}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\setlength{\emergencystretch}{5em}\tolerance=2000
\setlength{\lineskiplimit}{2pt}
\setlength{\lineskip}{5pt}
\setlength{\LTleft}{0pt}
\setlength{\tabcolsep}{4pt}
\allowdisplaybreaks
\newcommand{\one}{\mathrm{1\mkern-4.5mu l}}
\newsavebox{\formula}
% A displayed formula; if it is too wide, the second form, which TeX breaks at signs and relations.
\newcommand{\fit}[2]{\par\nobreak\savebox{\formula}{$\displaystyle #1$}%
  \ifdim\wd\formula>\linewidth #2\else\noindent\usebox{\formula}\par\fi}
% In it a fraction or a root that is too wide is written with a slash or a power.
\newcommand{\slashed}[2]{\setbox0\hbox{$\displaystyle\built{#1}{#2}$}%
  \ifdim\wd0>.85\linewidth\bigl(#1\bigr)\big/\bigl(#2\bigr)\else\built{#1}{#2}\fi}
\newcommand{\rooted}[2][]{\setbox0\hbox{$\displaystyle\radix[#1]{#2}$}%
  \ifdim\wd0>.95\linewidth\bigl(#2\bigr)^{1/\ifx\relax#1\relax 2\else #1\fi}\else\radix[#1]{#2}\fi}
\newcommand{\broken}[1]{{\small\let\built\frac\let\frac\slashed\let\radix\sqrt\let\sqrt\rooted\raggedright\relpenalty=50\binoppenalty=100
  \hangindent=2em\hangafter=1\noindent$\displaystyle #1$\par}}
% A picture of the folder beside this file.
\newcommand{\drawn}[1]{\IfFileExists{#1}{\includegraphics[width=\linewidth]{#1}}%
  {\emph{(\texttt{\detokenize{#1}})}}}
"""
END = "\\end{document}\n"

_LETTERS = {
    "−": "$-$", "–": "--", "⁻": "$^-$", "·": r"$\cdot$", "±": r"$\pm$", "∓": r"$\mp$", "×": r"$\times$", "ℓ": r"$\ell$",
    "≤": r"$\leq$", "≥": r"$\geq$", "≈": r"$\approx$", "≠": r"$\neq$", "→": r"$\to$", "…": r"\ldots{}", "°": r"$^\circ$",
    "≪": r"$\ll$", "≫": r"$\gg$", "‖": r"$\|$", "∝": r"$\propto$", "∘": r"$\circ$", "↔": r"$\leftrightarrow$", "∼": r"$\sim$",
    "∗": "$*$", "∑": r"$\sum$", "∏": r"$\prod$", "≡": r"$\equiv$", "⇒": r"$\Rightarrow$", "∈": r"$\in$", "ϕ": r"$\phi$",
    "ϵ": r"$\epsilon$", "—": "---", "“": "``", "”": "''", "„": "``", "‘": "`", "’": "'", "µ": r"$\mu$",
    "∫": r"$\int$", "∂": r"$\partial$", "∇": r"$\nabla$", "∞": r"$\infty$", "⟨": r"$\langle$", "⟩": r"$\rangle$",
    "†": r"$\dagger$", "′": "$'$", "″": "$''$", "ᵀ": "$^T$", "√": r"$\surd$",
    "§": r"$\mathsection$", "ß": r"\ss{}", "ø": r"\o{}", "Ø": r"\O{}", "ł": r"\l{}", "Ł": r"\L{}", "æ": r"\ae{}", "œ": r"\oe{}",
    "<": "$<$", ">": "$>$", "|": "$|$", "\\": r"\textbackslash{}", "^": r"\^{}",
    "~": r"\~{}", '"': "''",
} | {mark: f"$^{digit}$" for digit, mark in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")}  # fmt: skip
_ACCENTS = {mark: name for name, mark in ACCENTS.items() if name not in ".kb"}  # accents of the font in the head
_MARKS = {"\u0307": r"\dot", "\u0308": r"\ddot", "\u0302": r"\hat"}
_LOW = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
# A letter with mark and index is mathematics, unless it is a bare Latin letter.
_LETTER = re.compile(rf"(\w)([{''.join(_MARKS)}]?)([{''.join(_LOW)}]*)")
# sin{\left(\theta_1 \right)}: a one-letter argument needs no brackets.
_LONE = re.compile(r"\{\\left\((\\?[A-Za-z]+(?:_\{?\w+\}?)?) \\right\)\}")
_LONG_WORD = 18  # characters of a word beyond which TeX may break it
# Characters of the longest formula that is displayed.
_LONGEST = 2_500


def head(title: str, preamble: str = "") -> str:
    """Return the head of a LaTeX document with this title; `preamble` loads the packages of the paper's formulas."""
    about = rf"\hypersetup{{pdftitle={{{latex_prose(title)}}},pdfauthor={{The lagrotor developers}}}}"
    return f"{_HEAD}{preamble and preamble.strip() + chr(10)}{about}\n\\begin{{document}}\n"


def latex_prose(text: str) -> str:
    """Return plain text as LaTeX: formulas become readable, special characters are escaped, long words may break."""
    return " ".join(_word(word) for word in readable(text).split(" "))


def _word(word: str) -> str:
    if len(word) <= _LONG_WORD:
        return _LETTER.sub(_letter, "".join(map(_character, word)))
    pieces = re.findall(rf"(?:[^*/+=(),._-][\u0307\u0308₀-₉]*){{1,{_LONG_WORD // 2}}}|[*/+=(),._-]+", word)
    return r"\allowbreak{}".join(map(_word, pieces))


def _character(character: str) -> str:
    if character in "&%$#_{}":
        return f"\\{character}"
    if character in _LETTERS:
        return _LETTERS[character]
    if character.isascii() or character in GREEK or character in _MARKS or character in _LOW:
        return character
    letter, *marks = list(unicodedata.normalize("NFKD", character))
    if letter.isascii() and letter.isalpha() and len(marks) == 1 and marks[0] in _ACCENTS:
        return rf"\{_ACCENTS[marks[0]]}{{{letter}}}"
    return "".join((letter, *marks)).encode("ascii", "ignore").decode() or unknown(character)


def unknown(character: str) -> str:
    """Return LaTeX of a character for which no command is known: its name in Unicode."""
    return rf"\text{{[{unicodedata.name(character, f'U+{ord(character):04X}').lower()}]}}"


def _letter(match: re.Match[str]) -> str:
    stem, dot, index = match.groups()
    if stem in _LOW:  # an index without a letter, such as the limit of an integral
        stem, index = "", stem + index
    if stem.isascii() and not dot and not index:
        return stem
    drawn = GREEK.get(stem, stem)
    drawn = f"{_MARKS[dot]}{{{drawn}}}" if dot else drawn
    return f"${drawn}_{{{''.join(_LOW[digit] for digit in index)}}}$" if index else f"${drawn}$"


def displayed_formula(source: str) -> str:
    """Return LaTeX that sets a formula on its own line, and breaks it if it is too wide."""
    clean = tidy(source)
    return rf"\fit{{{clean}}}{{\broken{{{_loose(clean)}}}}}"


def tidy(source: str) -> str:
    """Return a formula in ASCII without the comma or full stop at its end."""
    clean = re.sub(r"[.,;]\s*$", "", source.strip()).replace(r"\mathbb{1}", r"\one ")
    clean = "".join(c if c.isascii() else GREEK.get(c) or _LETTERS.get(c, unknown(c)).strip("$") for c in clean)
    return _LONE.sub(r" \1 ", clean)


def displayed_expression(expression: sp.Basic) -> str:
    """Return LaTeX that sets an expression on its own line.

    A matrix that is too wide is listed by its elements; of a very long expression only the length is given.
    """
    source = latex(expression)
    if len(source) > _LONGEST:
        return f"This expression has {len(source)} characters; it is in verdicts.json."
    if not isinstance(expression, sp.MatrixBase):
        return displayed_formula(source)
    rows, columns = expression.shape
    elements = []
    for i, j in ((i, j) for i in range(rows) for j in range(columns)):
        index = f"{i + 1}" if columns == 1 else f"{i + 1}{j + 1}"
        elements.append(rf"\broken{{[\,\cdot\,]_{{{index}}} = {_loose(latex_inline(expression[i, j]))}}}")
    return rf"\fit{{{latex_inline(expression)}}}{{{' '.join(elements)}}}"


def latex_inline(expression: sp.Basic) -> str:
    """Return an expression without dollar signs; a matrix with fractions gets more space between its rows."""
    source = _LONE.sub(r" \1 ", latex(expression))
    tall = r"\begin{matrix}" in source and r"\frac" in source
    return source.replace(r"\frac", r"\dfrac").replace(r"\\", r"\\\noalign{\vskip 6pt}") if tall else source


def _loose(source: str) -> str:
    """Return a formula that TeX may break anywhere outside braces.

    Its brackets get a fixed size, and each wide space allows a break.
    """
    pieces: list[str] = []
    opened: list[int] = []
    for piece in (token.text for token in tokenize(source)):
        if piece == r"\left":
            opened.append(len(pieces))
            pieces.append("")
        elif piece == r"\right" and opened:
            start = opened.pop()
            big = r"\Big" if r"\frac" in "".join(pieces[start:]) else ""
            pieces[start] = f"{big}l" if big else ""
            pieces.append(f"{big}r" if big else "")
        else:
            pieces.append(piece)
    return "".join(pieces).replace(r"\quad", r"\quad\allowbreak ")


def _length(cell: str) -> int:
    """Return the approximate number of visible characters of a cell."""
    return len(re.sub(r"\\hyperlink\{.*?\}|\\\w+|[{}$\\]", "", cell))


def latex_table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """Return a table of LaTeX cells. It may span pages; the widths of its columns follow the length of their cells."""
    lines = list(rows)
    widest = 130 // len(head)
    need = [6 + min(widest, max(map(_length, column))) for column in zip(head, *lines, strict=True)]
    columns = "".join(
        rf">{{\raggedright\arraybackslash}}p{{\dimexpr {width / sum(need):.4f}\linewidth-2\tabcolsep\relax}}"
        for width in need
    )
    top = " & ".join(rf"\textbf{{{cell}}}" for cell in head)
    body = "\n".join(" & ".join(line) + r" \\" for line in lines)
    size, gap = r"\small" if len(head) < 5 else r"\footnotesize", r"\hline\noalign{\vskip 2pt}"
    begin, end = rf"{{{size}\begin{{longtable}}{{{columns}}}", r"\hline\end{longtable}}"
    return "\n".join([begin, gap, rf"{top} \\ {gap}\endhead", body, end])
