"""Plain text with formulas typed on a keyboard, as people read it: omega_1**2 is ω₁², -3 is −3, 3e-14 is 3×10⁻¹⁴."""

import re
from collections.abc import Callable

from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.shown import superscript

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
_ARROWS = {" -> ": " → ", " >= ": " ≥ ", " <= ": " ≤ ", "||": "‖"}
# A minus sign, none of the hyphens between words or in a range.
_MINUS = re.compile(
    r"(?<![^\s(=:;/,])-(?=[\dͰ-ϿD√]|(?:sin|cos|exp)\(|[A-Za-z](?:[_₀-₉/]| \())|(?<= )-(?= )|(?<=\()-(?=\()"
)


def readable(text: str) -> str:
    """The text with Greek letters, dots, primes and indices on names, powers raised, signs, and numbers in powers of ten.

    An index that is not a number stays as typed, F_y; so does a power that is not a whole number, r^1.96.
    """
    for typed, read in _RULES:
        text = typed.sub(read, text)
    for arrow, sign in _ARROWS.items():
        text = text.replace(arrow, sign)
    return _MINUS.sub("−", text)


def _in_powers_of_ten(match: re.Match[str]) -> str:
    sign, mantissa, power = match.groups()
    if float(mantissa) == 0:
        return "0"
    if int(power) == 0:
        return f"{sign}{mantissa}"
    ten = f"10{superscript(int(power))}"
    return sign.replace("-", "−") + (ten if float(mantissa) == 1 else f"{mantissa}×{ten}")


def from_latex(source: str) -> str:
    r"""LaTeX of a quantity in plain text: \dot\varphi_1 is φ̇₁, \Omega_0^2\ \text{(any rate)} is Ω₀² (any rate)."""
    text = re.sub(
        r"\\(?:text|mathcal|mathrm)\s*\{([^{}]*)\}|\\(?:mathcal|mathrm)\s+(\w)", lambda m: m[1] or m[2], source
    )
    text = re.sub(r"\\(?:left|right)\s*(?=[(){}\[\]|.\\])\.?", "", text)
    text = re.sub(r"([_^])\{(\w|\\\w+)\}", r"\1\2", text)
    text = re.sub(r"(?<=[A-Za-z])(?=\\(?:vec|hat)\b)", " ", text)
    text = re.sub(r"\\(?:vec|hat)\s*(?:\{([^{}]*)\})?", lambda m: m[1] or "", text)
    text = _quotients(text)
    text = re.sub(r"\\(d?dot)\s*(?:\{\\?(\w+)\}|\\?(\w+?))(?:_\{?(\d+)\}?)?(?![A-Za-z])", _dotted, text)
    text = re.sub(r"\\([A-Za-z]+)", lambda m: _SIGNS.get(m[1]) or _LETTERS.get(m[1], m[1]), text)
    text = re.sub(r"_\{?(\d+)\}?", lambda m: m[1].translate(_LOW), text)
    text = re.sub(r" ?\^\{?(\d+)\}?", lambda m: m[1].translate(_HIGH), text).replace("^T", "ᵀ")
    text = re.sub(r"(?<=[²³])(?=[A-Za-zΑ-ω])", " ", text)
    text = " ".join(re.sub(r"\\[,; !]|\\|[{}]", " ", text).replace("( ", "(").replace(" )", ")").split())
    return re.sub(r"(^|\()- ", r"\1−", text).replace(" - ", " − ")


def _quotients(text: str) -> str:
    r"""Quotients and roots of LaTeX on one line: \frac{a + b}{c} is (a + b)/c, \sqrt{x} is √x; the inmost first."""
    for _ in range(text.count("{") + 1):
        before = text
        text = re.sub(
            r"\\[dt]?frac\s*(?:\{([^{}]*)\}|(\d))\s*(?:\{([^{}]*)\}|(\d))",
            lambda m: f"{_factor(m[1] or m[2])}/{_factor(m[3] or m[4])} ",
            text,
        )
        text = re.sub(r"\\sqrt\s*(?:\{([^{}]*)\}|(\\?\w+))", lambda m: f"√{_factor(m[1] or m[2])}", text)
        text = re.sub(r"([_^])\{([^{}]*)\}", lambda m: f"{m[1]}{_factor(m[2])}", text)
        if text == before:
            break
    return text


def _factor(text: str) -> str:
    """In brackets unless it is one letter or number, indexed or raised."""
    alone = re.fullmatch(r"\s*(?:\\?[\w.]+|\([^()]*\))(?:_\\?\w+)?(?:\^\w)?\s*", text)
    return text.strip() if alone else f"({text.strip()})"


def _dotted(match: re.Match[str]) -> str:
    name, index = match[2] or match[3], match[4] or ""
    return _LETTERS.get(name, name) + _ABOVE[f"_{match[1]}"] + index.translate(_LOW)


def _letter(match: re.Match[str]) -> str:
    if match[0] == "Delta_t":  # a difference of t, not an index
        return "Δt"
    name, index, dots = match[1], match[2], match[3] or ""
    if name not in _LETTERS and (len(name) > 1 or (not index and not dots)):
        return match[0]
    low = index[1:].translate(_LOW) if index[1:].isdigit() else index
    return _LETTERS.get(name, name) + _ABOVE[dots] + low


_END = "[\\w)\u0307\u0308]"  # of what is before an operator
# What is typed, and what is read in its place, one after the other.
_RULES: tuple[tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]], ...] = (
    (re.compile(r"(?<![\w.])(-?)(\d+(?:\.\d+)?)e([+-]?\d+)(?!\w|\.\d)"), _in_powers_of_ten),
    (re.compile(r"(?<![\w\\])([A-Za-z]+)((?:_(?!d?dot)[A-Za-z0-9]+)*)(_d?dot)?(?![A-Za-z0-9_])"), _letter),
    # A letter with its index or its bracket, before a prime; a word's apostrophe is left alone.
    (
        re.compile(r"(?<![A-Za-z])((?:[A-Za-zͰ-Ͽϑϕ][₀-₉\u0307]*)|\))('{1,2})(?![A-Za-zͰ-Ͽ'])"),
        lambda match: match[1] + "′" * len(match[2]),
    ),
    (re.compile(rf"(?<={_END})(?:\*\*|\^)(\d+)(?![\d.])"), lambda match: match[1].translate(_HIGH)),
    (re.compile(r"(?<=[\w)|])\^(?:(\d+)|(T))(?![\w.])"), lambda match: (match[1] or "ᵀ").translate(_HIGH)),
    (re.compile(rf"(?<={_END})\*\*(?=[\w(])"), "^"),
    (re.compile(rf"(?<={_END})\*(?=[\w(])"), "·"),
    (re.compile(r"(?<=\b[A-Za-z]) x (?=[A-Za-z]\b)"), " × "),
    (re.compile(r"\bsqrt\("), "√("),
)
