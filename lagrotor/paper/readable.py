"""Plain text with formulas typed on a keyboard, as people read it: omega_1**2 is ω₁², -3 is −3."""

import re

from sympy.printing.pretty.pretty_symbology import greek_unicode

_LETTERS = greek_unicode | {"ell": "ℓ", "varepsilon": "ε", "vartheta": "ϑ", "varphi": "φ"}
_SIGNS = {
    "times": " × ",
    "cdot": " · ",
    "sin": "sin ",
    "cos": "cos ",
    "quad": " ",
    "qquad": " ",
    "left": " ",
    "right": " ",
}
_ABOVE = {"": "", "_dot": "\u0307", "_ddot": "\u0308"}
_LOW, _HIGH = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"), str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_END = "[\\w)\u0307\u0308]"  # of what stands before an operator
_NAME = re.compile(r"(?<![\w\\])([A-Za-z]+)(?:_(\d+))?(_d?dot)?(?![A-Za-z0-9_])")


def readable(text: str) -> str:
    """The text with Greek letters, dots and indices on names, raised powers, and signs; nothing else is touched."""
    text = _NAME.sub(_letter, text)
    text = re.sub(rf"(?<={_END})\*\*(\d+)", lambda match: match[1].translate(_HIGH), text)
    text = re.sub(rf"(?<={_END})\*\*(?=[\w(])", "^", text)
    text = re.sub(rf"(?<={_END})\*(?=[\w(])", "·", text)
    return re.sub(r"(?<![^\s(=:;/])-(?=[\dͰ-Ͽ])|(?<= )-(?= )", "−", text)


def scientific(value: float, digits: int = 0) -> str:
    """A number in powers of ten: 3e-14 as 3×10⁻¹⁴, with `digits` after the point; 0 as 0."""
    if value == 0:
        return "0"
    mantissa, _, power = f"{value:.{digits}e}".partition("e")
    return f"{mantissa.replace('-', '−')}×10{'⁻' * (int(power) < 0)}{str(abs(int(power))).translate(_HIGH)}"


def from_latex(source: str) -> str:
    r"""LaTeX of a quantity in plain text: \dot\varphi_1 is φ̇₁, \Omega_0^2\ \text{(any rate)} is Ω₀² (any rate)."""
    text = re.sub(
        r"\\(?:text|mathcal|mathrm)\s*\{([^{}]*)\}|\\(?:mathcal|mathrm)\s+(\w)", lambda m: m[1] or m[2], source
    )
    text = re.sub(r"\\(?:vec|hat)\s*", "", text)
    text = re.sub(r"\\(d?dot)\s*(?:\{\\?(\w+)\}|\\?(\w+?))(?:_\{?(\d+)\}?)?(?![A-Za-z])", _dotted, text)
    text = re.sub(r"\\([A-Za-z]+)", lambda m: _SIGNS.get(m[1]) or _LETTERS.get(m[1], m[1]), text)
    text = re.sub(r"_\{?(\d+)\}?", lambda m: m[1].translate(_LOW), text)
    text = re.sub(r"\^\{?(\d+)\}?", lambda m: m[1].translate(_HIGH), text)
    return " ".join(re.sub(r"\\[,; !]|\\|[{}]", " ", text).split())


def _dotted(match: re.Match[str]) -> str:
    name, index = match[2] or match[3], match[4] or ""
    return _LETTERS.get(name, name) + _ABOVE[f"_{match[1]}"] + index.translate(_LOW)


def _letter(match: re.Match[str]) -> str:
    name, index, dots = match[1], match[2] or "", match[3] or ""
    if name not in _LETTERS and len(name) > 1:
        return match[0]
    return _LETTERS.get(name, name) + _ABOVE[dots] + index.translate(_LOW)
