"""Conversion of typed formulas and LaTeX to plain text: omega_1**2 is ω₁², -3 is −3, 3e-14 is 3×10⁻¹⁴."""

import re
from collections import deque
from collections.abc import Callable

from sympy.printing.pretty.pretty_symbology import greek_unicode

from lagrotor.paper.latex.tokens import NESTING, Token, tokenize
from lagrotor.result_display import superscript

_LETTERS = greek_unicode | {"ell": "ℓ", "varepsilon": "ε", "vartheta": "ϑ", "varphi": "φ"}
_SIGNS = {
    "times": " × ", "cdot": " · ", "sin": "sin ", "cos": "cos ", "quad": " ", "qquad": " ", "int": "∫", "sum": "Σ ",
    "nabla": "∇", "infty": "∞", "approx": " ≈ ", "langle": "⟨", "rangle": "⟩", "pm": " ± ", "to": " → ", "dagger": "†",
}  # fmt: skip
_FONTS = ("text", "mathcal", "mathrm", "mathbf", "boldsymbol", "operatorname", "vec", "hat")
_ABOVE = {"": "", "_dot": "\u0307", "_ddot": "\u0308"}
_LOW, _HIGH = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"), str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_ARROWS = {"+/-": "±", " -> ": " → ", " >= ": " ≥ ", " <= ": " ≤ ", "||": "‖"}
# A minus sign, but no hyphen between words or in a range.
_MINUS = re.compile(
    r"(?<![^\s(\[=:;/,])-(?=[\dͰ-ϿD√]|(?:sin|cos|exp)\(|[A-Za-z](?:[_₀-₉/]| \())|(?<= )-(?= )|(?<=\()-(?=\()"
)


def readable(text: str) -> str:
    """Return a typed text with Greek letters, dots, primes, indices, raised powers, minus signs and powers of ten."""
    for typed, read in _RULES:
        text = typed.sub(read, text)
    for arrow, sign in _ARROWS.items():
        text = text.replace(arrow, sign)
    return _MINUS.sub("−", text)


def readable_on_page(text: str) -> str:
    r"""Return `readable` text with the letter ϕ of the formulas, in which it is \phi, instead of the φ of terminals."""
    return readable(text).replace("φ", "ϕ")


def _in_powers_of_ten(match: re.Match[str]) -> str:
    sign, mantissa, power = match.groups()
    if float(mantissa) == 0:
        return "0"
    if int(power) == 0:
        return f"{sign}{mantissa}"
    ten = f"10{superscript(int(power))}"
    return sign.replace("-", "−") + (ten if float(mantissa) == 1 else f"{mantissa}×{ten}")


def from_latex(source: str) -> str:
    r"""Return LaTeX as plain text: \dot\varphi_1 becomes φ̇₁, \Omega_0^2\ \text{(any rate)} becomes Ω₀² (any rate)."""
    tokens = (Token(t.kind, c, t.at) for t in tokenize(source) for c in (t.text if t.kind == "text" else (t.text,)))
    text = re.sub(r"(?<=[²³])(?=[A-Za-zΑ-ω])", " ", _line(deque(tokens)))
    text = " ".join(text.split()).replace("( ", "(").replace(" )", ")").replace("⟨ ", "⟨").replace(" ⟩", "⟩")
    return re.sub(r"(^|\()- ", r"\1−", text).replace(" - ", " − ")


def _line(tokens: deque[Token]) -> str:
    """Convert tokens of LaTeX to text, up to the closing brace or the end."""
    text = ""
    while tokens and (token := tokens.popleft()).kind != "close":
        text = f"{text.rstrip() if token.kind == 'script' else text}{_piece(token, tokens)}"
    return text


def _piece(token: Token, tokens: deque[Token]) -> str:
    if token.kind == "open":
        return _line(tokens)
    if token.kind == "script":
        inner = _argument(tokens).strip()
        if not inner:
            return ""
        if inner.isdigit():
            return inner.translate(_LOW if token.text == "_" else _HIGH)
        return "ᵀ" if (token.text, inner) == ("^", "T") else f"{token.text}{_factor(inner)}"
    return _command(token.text[1:], tokens) if token.kind == "command" else " " if token.kind == "align" else token.text


def _argument(tokens: deque[Token]) -> str:
    while tokens and not tokens[0].text.strip():
        tokens.popleft()
    return _piece(tokens.popleft(), tokens) if tokens else ""


def _command(name: str, tokens: deque[Token]) -> str:
    if name in ("frac", "dfrac", "tfrac"):
        over, under = _factor(_argument(tokens)), _factor(_argument(tokens))
        return f"{' ' * (over[0] == 'd')}{over}/{under} "
    if name == "partial":
        return "∂" if tokens and tokens[0].kind == "close" else f"∂{_argument(tokens)}"
    if name == "sqrt":
        return f"√{_factor(_argument(tokens))}"
    if name in ("dot", "ddot"):
        inner = _argument(tokens).strip()
        return inner[:1] + _ABOVE[f"_{name}"] + inner[1:]
    if name in ("left", "right"):
        if tokens and tokens[0].text == ".":
            tokens.popleft()
        return ""
    if name in ("begin", "end"):
        return _matrix(tokens) if _argument(tokens).endswith("matrix") and name == "begin" else " "
    if name == "mathrm" and [t.text for t, _ in zip(tokens, range(3), strict=False)] == [
        "{",
        "d",
        "}",
    ]:  # a differential
        differential = f" {_argument(tokens)}"
        return differential + (_argument(tokens) if tokens and tokens[0].kind in ("text", "command") else "")
    if name in _FONTS:
        return f" {_argument(tokens)}" if name in ("vec", "hat") else _argument(tokens)
    return _SIGNS.get(name) or _LETTERS.get(name, name if name.isalpha() else " ")


def _matrix(tokens: deque[Token]) -> str:
    r"""Convert the tokens of a matrix, up to its end, to the text [a, b; c, d]."""
    inner, depth = list[Token](), 1
    while tokens and depth:
        token = tokens.popleft()
        depth += NESTING.get(token.text, 0)
        inner.append(
            Token("text", {"&": ", ", r"\\": "; "}[token.text], 0)
            if depth == 1 and token.text in ("&", r"\\")
            else token
        )
    _argument(tokens)
    rows = re.sub(r" +([,;])", r"\1", _line(deque(inner[:-1]))).strip()
    return f" [{rows}] "


def _factor(text: str) -> str:
    """Put a text in brackets, unless it is a single symbol or number with an optional index or power."""
    alone = re.fullmatch(r"\s*(?:[\w.∂\u0307\u0308]+|\([^()]*\))(?:_\w+)?(?:\^\w)?\s*", text)
    return text.strip() if alone else f"({text.strip()})"


def _letter(match: re.Match[str]) -> str:
    if match[0] == "Delta_t":  # a difference of t, not an index
        return "Δt"
    name, index, dots = match[1], match[2], match[3] or ""
    if name not in _LETTERS and (len(name) > 1 or (not index and not dots)):
        return match[0]
    low = index[1:].translate(_LOW) if index[1:].isdigit() else index
    return _LETTERS.get(name, name) + _ABOVE[dots] + low


_END = "[\\w)\u0307\u0308]"  # the character before an operator
# Patterns and replacements, in this order.
_RULES: tuple[tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]], ...] = (
    (re.compile(r"(?<![\w.])(-?)(\d+(?:\.\d+)?)e([+-]?\d+)(?!\w|\.\d)"), _in_powers_of_ten),
    (re.compile(r"(?<![\w\\])([A-Za-z]+)((?:_(?!d?dot)[A-Za-z0-9]+)*)(_d?dot)?(?![A-Za-z0-9_])"), _letter),
    # A symbol with its index, or a bracket, before a prime; the apostrophe of a word stays.
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
