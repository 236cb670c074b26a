"""Expressions as MathML in the glossary's letters, which browsers draw without any script."""

import re
from html import unescape
from xml.dom import minidom
from xml.etree.ElementTree import Element

import sympy as sp
from sympy.printing.mathml import MathMLPresentationPrinter
from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.pair.symbols import GLOSSARY
from lagrotor.report.formulas.mathml_break import math
from lagrotor.report.formulas.mathml_layout import join, laid_out, leaf

# A glossary letter: \dot{\theta}_{1} is an accent, a stem and an index.
_LETTER = re.compile(r"(?:\\(d?dot)\{)?\\?([A-Za-z]+)\}?(?:_\{?(\w+)\}?)?$")
_ACCENTS = {"dot": "˙", "ddot": "¨"}
# As LaTeX draws \phi and \varphi, \epsilon and \varepsilon.
_LETTERS = greek_unicode | {"ell": "ℓ", "phi": "ϕ", "varphi": "φ", "vartheta": "ϑ", "epsilon": "ϵ", "varepsilon": "ε"}


class _Printer(MathMLPresentationPrinter):  # type: ignore[misc]
    """sympy's printer, but with accents and indices as the glossary writes them, sin x, and sin² x for (sin x)²."""

    def _print_Symbol(self, symbol: sp.Symbol, style: str = "plain") -> minidom.Element:
        match = _LETTER.match(_letter(symbol))
        if not match:
            return super()._print_Symbol(symbol, style)
        accent, stem, index = match.groups()
        node = self._leaf("mi", _LETTERS.get(stem, stem))
        if accent:
            node = self._join("mover", node, self._leaf("mo", _ACCENTS[accent]))
        if index:
            parts = [self._leaf("mn" if part.isdigit() else "mi", part) for part in index.split("_")]
            node = self._join("msub", node, self._join("mrow", *parts))
        return node

    def _print_Function(self, function: sp.Function) -> minidom.Element:
        if not isinstance(function, sp.sin | sp.cos | sp.tan):
            return super()._print_Function(function)
        return self._applied(self._leaf("mi", function.func.__name__), function.args[0])

    def _print_Pow(self, power: sp.Pow) -> minidom.Element:
        function, exponent = power.args
        if not (isinstance(function, sp.sin | sp.cos | sp.tan) and exponent.is_Integer and exponent > 1):
            return super()._print_Pow(power)
        name = self._join("msup", self._leaf("mi", function.func.__name__), self._print(exponent))
        return self._applied(name, function.args[0])

    def _applied(self, name: minidom.Element, argument: sp.Basic) -> minidom.Element:
        inside = self._print(argument)
        if argument.is_Symbol:
            return self._join("mrow", name, inside)
        return self._join("mrow", name, self._leaf("mo", "("), inside, self._leaf("mo", ")"))

    def _leaf(self, tag: str, text: str) -> minidom.Element:
        node = self.dom.createElement(tag)
        node.appendChild(self.dom.createTextNode(text))
        return node

    def _join(self, tag: str, *children: minidom.Node) -> minidom.Element:
        node = self.dom.createElement(tag)
        for child in children:
            node.appendChild(child)
        return node


def _letter(symbol: sp.Symbol) -> str:
    """The glossary's LaTeX of a symbol, or the same read off its name."""
    if symbol in GLOSSARY:
        return GLOSSARY[symbol].latex
    name, _, accent = symbol.name.rpartition("_")
    if accent not in _ACCENTS:
        return symbol.name
    stem, _, index = name.partition("_")
    return rf"\{accent}{{{stem}}}" + (f"_{{{index}}}" if index else "")


def _element(node: minidom.Element) -> Element:
    """The printer's node as the layout takes it: characters for entities, brackets for `mfenced`."""
    texts = [unescape(child.data) for child in node.childNodes if isinstance(child, minidom.Text)]
    children = [_element(child) for child in node.childNodes if isinstance(child, minidom.Element)]
    if node.tagName == "mfenced":
        ends = [leaf("mo", node.getAttribute(name) or mark) for name, mark in (("open", "("), ("close", ")"))]
        inside = [part for child in children for part in (leaf("mo", ","), child)][1:]
        return join("mrow", (ends[0], *inside, ends[1]))
    return join(node.tagName, children) if children else leaf(node.tagName, "".join(texts))


def mathml(expression: sp.Basic, display: bool = True) -> str:
    """An expression as a `<math>` element, on its own line, broken where it is long, or within a line."""
    return math(laid_out([_element(_Printer()._print(expression))]), display)
