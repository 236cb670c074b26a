"""Expressions as MathML in the glossary's letters, which browsers draw without any script."""

import re
from html import unescape
from typing import Any
from xml.dom.minidom import Element, Node

import sympy as sp
from sympy.printing.mathml import MathMLPresentationPrinter
from sympy.printing.pretty.pretty_symbology import greek_unicode

from ..symbols import GLOSSARY

# A glossary letter: \dot{\theta}_{1} is an accent, a stem and an index.
_LETTER = re.compile(r"(?:\\(d?dot)\{)?\\?([A-Za-z]+)\}?(?:_\{?(\w+)\}?)?$")
_TALL = ("mfrac", "mtable", "msqrt", "mroot")
_ACCENTS = {"dot": "˙", "ddot": "¨"}
_LETTERS = greek_unicode | {"ell": "ℓ"}


class _Printer(MathMLPresentationPrinter):  # type: ignore[misc]
    """sympy's printer, but with accents and indices as the glossary writes them, and sin²(x) for sin(x)²."""

    def _print_Symbol(self, symbol: sp.Symbol, style: str = "plain") -> Element:
        match = _LETTER.match(_letter(symbol))
        if not match:
            return super()._print_Symbol(symbol, style)
        accent, stem, index = match.groups()
        node = self._leaf("mi", _LETTERS.get(stem, stem))
        if accent:
            node = self._join("mover", node, self._leaf("mo", _ACCENTS[accent]))
            node.setAttribute("accent", "true")
        if index:
            node = self._join("msub", node, self._leaf("mn" if index.isdigit() else "mi", index.replace("_", " ")))
        return node

    def _print_Pow(self, power: sp.Pow) -> Element:
        function, exponent = power.args
        if not (isinstance(function, sp.sin | sp.cos) and exponent.is_Integer and exponent > 1):
            return super()._print_Pow(power)
        name = self._join("msup", self._leaf("mi", function.func.__name__), self._print(exponent))
        argument = (self._leaf("mo", "("), self._print(function.args[0]), self._leaf("mo", ")"))
        return self._join("mrow", name, self._leaf("mo", "\u2061"), self._join("mrow", *argument))

    def _leaf(self, tag: str, text: str) -> Element:
        node = self.dom.createElement(tag)
        node.appendChild(self.dom.createTextNode(text))
        return node

    def _join(self, tag: str, *children: Node) -> Element:
        node = self.dom.createElement(tag)
        for child in children:
            node.appendChild(child)
        return node

    def drawn(self, expression: sp.Basic) -> str:
        return str(_plain(self._join("mrow", self._print(expression)), self).toxml())


def _letter(symbol: sp.Symbol) -> str:
    """The glossary's LaTeX of a symbol, or the same read off its name."""
    if symbol in GLOSSARY:
        return GLOSSARY[symbol].latex
    name, _, accent = symbol.name.rpartition("_")
    if accent not in _ACCENTS:
        return symbol.name
    stem, _, index = name.partition("_")
    return rf"\{accent}{{{stem}}}" + (f"_{{{index}}}" if index else "")


def _plain(node: Any, printer: _Printer) -> Any:
    """The tree without what browsers no longer draw (`mfenced`, entities by name), low brackets not stretched."""
    for child in list(node.childNodes):
        if child.nodeType == Node.TEXT_NODE:
            child.data = unescape(child.data)
        else:
            node.replaceChild(_plain(child, printer), child)
    if node.nodeName == "mfenced":
        node = _unfenced(node, printer)
    if not any(node.getElementsByTagName(tag) for tag in _TALL):
        for bracket in node.getElementsByTagName("mo"):
            bracket.setAttribute("stretchy", "false")
    return node


def _unfenced(node: Any, printer: _Printer) -> Element:
    inside = list(node.childNodes)
    row = [printer._leaf("mo", node.getAttribute("open") or "(")]
    for i, child in enumerate(inside):
        row += [printer._leaf("mo", ",")] * bool(i) + [child]
    return printer._join("mrow", *row, printer._leaf("mo", node.getAttribute("close") or ")"))


def mathml(expression: sp.Basic, display: bool = True) -> str:
    """An expression as a `<math>` element, on its own line or within one."""
    kind = ' display="block"' if display else ""
    return f"<math{kind}>{_Printer().drawn(expression)}</math>"
