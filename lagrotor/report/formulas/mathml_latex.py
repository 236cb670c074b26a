"""Printed formulas: LaTeX as MathML, by latex2mathml, in the same layout as the derived expressions."""

from html import unescape
from importlib.metadata import PackageNotFoundError, version

from lagrotor.report.formulas.mathml_break import math
from lagrotor.report.formulas.mathml_layout import laid_out


def converter() -> str:
    """The version of latex2mathml; empty where it is not installed."""
    try:
        return version("latex2mathml")
    except PackageNotFoundError:
        return ""


def from_latex(source: str, display: bool = True) -> str | None:
    """A LaTeX formula as a `<math>` element, on its own line or within one; None where latex2mathml is not installed."""
    try:
        from latex2mathml.converter import Converter
    except ModuleNotFoundError:
        return None
    tree = Converter(display="block" if display else "inline").convert_to_element(
        source.replace("{aligned}", "{align*}")
    )
    for node in tree.iter():
        node.text = unescape(node.text or "")  # the converter leaves characters as entities
    return math(laid_out(tree), display)
