r"""The commands of common packages as macros, each with its arguments in the letters of \NewDocumentCommand; units of siunitx."""

import re

# A line: the command, its arguments, its definition. The commands of "" are known without a package.
TABLE = {
    "": r"""
        \bm m \boldsymbol{#1}
        \pmb m \boldsymbol{#1}
        \ensuremath m #1
        \coloneqq - :=
        \eqqcolon - =:
        \vcentcolon - :
        \mathclap m #1
        \mathllap m #1
        \mathrlap m #1
        \smashoperator m #1
        \smash om #2
        \lefteqn m #1
        \MoveEqLeft o
        \Aboxed m #1
        \boxed m #1
        \fbox m #1
        \hspace sm \,
        \mspace m \,
        \phantom m \,
        \hphantom m \,
        \vspace sm
        \vphantom m
        \color om
        \textcolor omm #3
        \mathstrut -
        \displaylimits -
        \hfil -
        \mathchoice mmmm #1
        \lbrack - [
        \rbrack - ]
        \IEEEeqnarraymulticol mmm #3
        \import mm \input{#1#2}
        \includestandalone om \input{#2}
        \@power m \IfValueT{#1}{^{#1}}
        \@quotient mmmm \IfValueTF{#4}{\frac{#1\@power{#2} #3}{#1 #4\@power{#2}}}{\frac{#1\@power{#2} }{#1 #3\@power{#2}}}
        \@bracket mmm \IfValueT{#2}{\left#1 #2 \right#3}
        \@matrix mm \IfValueT{#2}{\begin{#1}#2\end{#1}}
        """,
    "physics": r"""
        \dv somg \@quotient{\mathrm{d}}{#2}{#3}{#4}
        \fdv somg \@quotient{\delta}{#2}{#3}{#4}
        \pdv somgg \IfValueTF{#5}{\frac{\partial^{2} #3}{\partial #4 \partial #5}}{\@quotient{\partial}{#2}{#3}{#4}}
        \derivative somg \dv[#2]{#3}{#4}
        \dd og \,\mathrm{d}\@power{#1} \IfValueT{#2}{#2}
        \qty sd()d[]d||g \@bracket({#2})\@bracket[{#3}]\@bracket|{#4}|\@bracket\{{#5}\}
        \mqty sd()d[]d||g \@matrix{pmatrix}{#2}\@matrix{bmatrix}{#3}\@matrix{vmatrix}{#4}\@matrix{matrix}{#5}
        \pmqty m \begin{pmatrix}#1\end{pmatrix}
        \bmqty m \begin{bmatrix}#1\end{bmatrix}
        \vmqty m \begin{vmatrix}#1\end{vmatrix}
        \pqty sm \left( #2 \right)
        \bqty sm \left[ #2 \right]
        \vqty sm \left| #2 \right|
        \Bqty sm \left\{ #2 \right\}
        \abs sm \left| #2 \right|
        \absolutevalue sm \left| #2 \right|
        \norm sm \left\| #2 \right\|
        \eval sm \left. #2 \right|
        \order sm \mathcal{O}\left(#2\right)
        \vb sm \mathbf{#2}
        \va sm \vec{\mathbf{#2}}
        \vu sm \hat{\mathbf{#2}}
        \vdot - \cdot
        \cross - \times
        \cp - \times
        \grad g \nabla \IfValueT{#1}{#1}
        \div g \nabla\cdot \IfValueT{#1}{#1}
        \curl g \nabla\times \IfValueT{#1}{#1}
        \laplacian g \nabla^{2} \IfValueT{#1}{#1}
        \pb mm \left\{ #1, #2 \right\}
        \var - \delta
        \variation - \delta
        \qq sm \quad\text{#2}\quad
        \qc - ,\quad
        """
    + "".join(
        rf"\q{word} - \quad\text{{{word}}}\quad" + "\n" for word in ("and", "or", "if", "for", "since", "with", "then")
    )
    + "".join(
        rf"\{name} o \{name}\@power{{#1}}" + "\n"
        for name in [
            "sin",
            "cos",
            "tan",
            "csc",
            "sec",
            "cot",
            "sinh",
            "cosh",
            "tanh",
            "arcsin",
            "arccos",
            "arctan",
            "exp",
            "log",
            "ln",
        ]
    ),
    "siunitx": r"""
        \SI omom \num{#2}\,\unit{#4}
        \qty omm \num{#2}\,\unit{#3}
        \ang om #2^\circ
        """,
    "commath": r"""
        \od omm \@quotient{\mathrm{d}}{#1}{#2}{#3}
        \dod omm \@quotient{\mathrm{d}}{#1}{#2}{#3}
        \tod omm \@quotient{\mathrm{d}}{#1}{#2}{#3}
        \pd omm \@quotient{\partial}{#1}{#2}{#3}
        \dpd omm \@quotient{\partial}{#1}{#2}{#3}
        \tpd omm \@quotient{\partial}{#1}{#2}{#3}
        \abs sm \left| #2 \right|
        \norm sm \left\| #2 \right\|
        \del om \left( #2 \right)
        \sbr om \left[ #2 \right]
        \cbr om \left\{ #2 \right\}
        \eval om \left. #2 \right|
        """,
}
# Packages of TeX's distributions of which a copy may lie beside a source: it is not read.
DISTRIBUTED = frozenset(
    [
        "amsmath",
        "amssymb",
        "amsfonts",
        "amsthm",
        "amsbsy",
        "amstext",
        "mathtools",
        "bm",
        "braket",
        "physics2",
        "graphicx",
        "graphics",
        "xcolor",
        "color",
        "hyperref",
        "url",
        "natbib",
        "cite",
        "cleveref",
        "babel",
        "inputenc",
        "fontenc",
        "geometry",
        "subfigure",
        "subcaption",
        "caption",
        "tikz",
        "pgf",
        "pgfplots",
        "mathrsfs",
        "dsfont",
        "bbm",
        "esint",
        "stmaryrd",
        "cancel",
        "tensor",
        "xparse",
        "etoolbox",
        "ifthen",
        "float",
        "booktabs",
        "multirow",
        "enumitem",
        "lineno",
        "newtxmath",
        "txfonts",
    ]
)
_UNITS = {
    "metre": "m", "meter": "m", "second": "s", "kilogram": "kg", "gram": "g", "newton": "N", "joule": "J", "watt": "W",
    "hertz": "Hz", "radian": "rad", "kelvin": "K", "ampere": "A", "volt": "V", "pascal": "Pa", "degree": r"^\circ",
}  # fmt: skip
_PREFIXES = {"": "", "kilo": "k", "mega": "M", "giga": "G", "milli": "m", "micro": "u", "nano": "n", "centi": "c"}
_UNIT = re.compile(
    rf"(\\per)?\s*(?:\\({'|'.join(filter(None, _PREFIXES))}))?\s*\\({'|'.join(_UNITS)})(?![a-z])\s*(?:\\(squared|cubed))?\s*"
)


def unit_print(text: str) -> str:
    r"""Return \metre\per\second\squared as \mathrm{m\,s^{-2}}, and other text as it is."""
    if _UNIT.sub("", text):
        return rf"\mathrm{{{text}}}"
    parts = []
    for per, prefix, name, power in _UNIT.findall(text):
        exponent = ("-" if per else "") + {"squared": "2", "cubed": "3", "": "1"}[power]
        parts.append(_PREFIXES[prefix] + _UNITS[name] + (f"^{{{exponent}}}" if exponent != "1" else ""))
    return r"\mathrm{" + r"\,".join(parts) + "}"


def number_print(text: str) -> str:
    r"""Return 3.2e-5 as 3.2\times 10^{-5}."""
    text = text.replace(" ", "").replace(",", ".")
    match = re.fullmatch(r"([+-]?[\d.]+)[eE]([+-]?\d+)", text)
    return rf"{match[1]}\times 10^{{{int(match[2])}}}" if match else text
