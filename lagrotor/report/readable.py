"""Plain text with formulas typed on a keyboard, as people read it: omega_1**2 is ω₁², -3 is −3."""

import re

from sympy.printing.pretty.pretty_symbology import greek_unicode

_LETTERS = greek_unicode | {"ell": "ℓ", "varepsilon": "ε", "vartheta": "ϑ", "varphi": "φ"}
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


def _letter(match: re.Match[str]) -> str:
    name, index, dots = match[1], match[2] or "", match[3] or ""
    if name not in _LETTERS and len(name) > 1:
        return match[0]
    return _LETTERS.get(name, name) + _ABOVE[dots] + index.translate(_LOW)
