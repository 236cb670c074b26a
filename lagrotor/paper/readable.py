"""Plain text with formulas typed on a keyboard, as people read it: omega_1**2 is ω₁², -3 is −3, 3e-14 is 3×10⁻¹⁴."""

import re

from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.shown import raised

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
_END = "[\\w)\u0307\u0308]"  # of what is before an operator
_NAME = re.compile(r"(?<![\w\\])([A-Za-z]+)((?:_(?!d?dot)[A-Za-z0-9]+)*)(_d?dot)?(?![A-Za-z0-9_])")
_NUMBER = re.compile(r"(?<![\w.])(-?)(\d+(?:\.\d+)?)e([+-]?\d+)(?!\w|\.\d)")
# A letter with its index or its bracket, before a prime; a word's apostrophe is left alone.
_PRIMED = re.compile(r"(?<![A-Za-z])((?:[A-Za-zͰ-Ͽϑϕ][₀-₉\u0307]*)|\))('{1,2})(?![A-Za-zͰ-Ͽ'])")
_ARROWS = {"->": "→", ">=": "≥", "<=": "≤", "||": "‖"}


def readable(text: str) -> str:
    """The text with Greek letters, dots, primes and indices on names, powers raised, signs, and numbers in powers of ten.

    An index that is not a number stays as typed, F_y; so does a power that is not a whole number, r^1.96.
    """
    text = _NUMBER.sub(_in_powers_of_ten, text)
    text = _NAME.sub(_letter, text)
    text = _PRIMED.sub(lambda match: match[1] + "′" * len(match[2]), text)
    text = re.sub(rf"(?<={_END})(?:\*\*|\^)(\d+)(?![\d.])", lambda match: match[1].translate(_HIGH), text)
    text = re.sub(r"(?<=[\w)|])\^(?:(\d+)|(T))(?![\w.])", lambda match: (match[1] or "ᵀ").translate(_HIGH), text)
    text = re.sub(rf"(?<={_END})\*\*(?=[\w(])", "^", text)
    text = re.sub(rf"(?<={_END})\*(?=[\w(])", "·", text)
    text = re.sub(r"(?<=\b[A-Za-z]) x (?=[A-Za-z]\b)", " × ", text)
    text = re.sub(r"\bsqrt\(", "√(", text)
    for typed, sign in _ARROWS.items():
        text = text.replace(f" {typed} ", f" {sign} ") if typed != "||" else text.replace(typed, sign)
    return re.sub(
        r"(?<![^\s(=:;/,])-(?=[\dͰ-ϿD√]|(?:sin|cos|exp)\(|[A-Za-z](?:[_₀-₉/]| \())|(?<= )-(?= )|(?<=\()-(?=\()",
        "−",
        text,
    )


def _in_powers_of_ten(match: re.Match[str]) -> str:
    sign, mantissa, power = match.groups()
    if float(mantissa) == 0:
        return "0"
    if int(power) == 0:
        return f"{sign}{mantissa}"
    ten = f"10{raised(int(power))}"
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
