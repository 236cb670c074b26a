r"""The commands of common packages as macros, each with its arguments in the letters of \NewDocumentCommand; units of siunitx."""

import re

# A line: commands, their arguments, their definition. The commands of "" are known without a package.
TABLE = {
    "": r"""
        \bm,\pmb m \boldsymbol{#1}
        \ensuremath,\mathclap,\mathllap,\mathrlap,\smashoperator,\lefteqn,\Aboxed,\boxed,\fbox m #1
        \coloneqq - :=
        \eqqcolon - =:
        \vcentcolon - :
        \smash om #2
        \mspace,\phantom,\hphantom m \,
        \hspace sm \,
        \vspace sm
        \vphantom m
        \MoveEqLeft,\displaybreak,\allowdisplaybreaks o
        \raisetag,\noalign m
        \color om
        \textcolor omm #3
        \mathstrut,\displaylimits,\hfil -
        \mathchoice mmmm #1
        \lbrack - [
        \rbrack - ]
        \IEEEeqnarraymulticol mmm #3
        \import mm \input{#1#2}
        \AtBeginDocument m #1
        \@power m \IfValueT{#1}{^{#1}}
        \@quotient mmmm \IfValueTF{#4}{\frac{#1\@power{#2} #3}{#1 #4\@power{#2}}}{\frac{#1\@power{#2} }{#1 #3\@power{#2}}}
        \@bracket mmm \IfValueT{#2}{\left#1 #2 \right#3}
        """,
    "physics": r"""
        \dv,\derivative somg \@quotient{\mathrm{d}}{#2}{#3}{#4}
        \fdv somg \@quotient{\delta}{#2}{#3}{#4}
        \pdv somgg \IfValueTF{#5}{\frac{\partial^{2} #3}{\partial #4 \partial #5}}{\@quotient{\partial}{#2}{#3}{#4}}
        \dd og \,\mathrm{d}\@power{#1} \IfValueT{#2}{#2}
        \qty sd()d[]d||g \@bracket({#2})\@bracket[{#3}]\@bracket|{#4}|\@bracket\{{#5}\}
        \pmqty m \begin{pmatrix}#1\end{pmatrix}
        \bmqty m \begin{bmatrix}#1\end{bmatrix}
        \vmqty m \begin{vmatrix}#1\end{vmatrix}
        \pqty sm \left( #2 \right)
        \bqty sm \left[ #2 \right]
        \Bqty sm \left\{ #2 \right\}
        \abs,\absolutevalue,\vqty sm \left| #2 \right|
        \norm sm \left\| #2 \right\|
        \eval sm \left. #2 \right|
        \order sm \mathcal{O}\left(#2\right)
        \vb sm \mathbf{#2}
        \va sm \vec{\mathbf{#2}}
        \vu sm \hat{\mathbf{#2}}
        \vdot - \cdot
        \cross,\cp - \times
        \grad g \nabla \IfValueT{#1}{#1}
        \div g \nabla\cdot \IfValueT{#1}{#1}
        \curl g \nabla\times \IfValueT{#1}{#1}
        \laplacian g \nabla^{2} \IfValueT{#1}{#1}
        \pb mm \left\{ #1, #2 \right\}
        \var,\variation - \delta
        \qq sm \quad\text{#2}\quad
        \qc - ,\quad
        """,
    "siunitx": r"""
        \SI omom \num{#2}\,\unit{#4}
        \qty omm \num{#2}\,\unit{#3}
        """,
    "commath": r"""
        \dif,\Dif - \mathrm{d}
        \od,\dod,\tod omm \@quotient{\mathrm{d}}{#1}{#2}{#3}
        \pd,\dpd,\tpd omm \@quotient{\partial}{#1}{#2}{#3}
        \abs sm \left| #2 \right|
        \norm sm \left\| #2 \right\|
        \del om \left( #2 \right)
        \sbr om \left[ #2 \right]
        \cbr om \left\{ #2 \right\}
        \eval om \left. #2 \right|
        """,
}
for _name in ("and", "or", "if", "for", "with"):
    TABLE["physics"] += f"\\q{_name} - \\quad\\text{{{_name}}}\\quad\n"
for _name in "sin cos tan csc sec cot sinh cosh tanh arcsin arccos arctan exp log ln".split():  # noqa: SIM905
    TABLE["physics"] += f"\\{_name} o \\{_name}\\@power{{#1}}\n"
# Packages of TeX's distributions of which a copy may lie beside a source: it is not read.
_NAMES = (
    "amsmath amssymb amsfonts amsthm amsbsy amstext mathtools bm braket physics2 graphicx graphics xcolor color hyperref url"
    " natbib cite cleveref babel inputenc fontenc geometry subfigure subcaption caption tikz pgf pgfplots mathrsfs dsfont bbm"
    " esint stmaryrd cancel tensor xparse etoolbox ifthen float booktabs multirow enumitem lineno newtxmath txfonts"
)
DISTRIBUTED = frozenset(_NAMES.split())
_UNITS = {
    "metre": "m", "meter": "m", "second": "s", "kilogram": "kg", "gram": "g", "newton": "N", "joule": "J", "watt": "W",
    "hertz": "Hz", "radian": "rad", "kelvin": "K", "ampere": "A", "volt": "V", "pascal": "Pa", "minute": "min", "hour": "h",
    "degree": r"^\circ",
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
