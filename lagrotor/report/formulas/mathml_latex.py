"""Formulas of the pages: latex2mathml converts LaTeX to MathML, which is then reduced to MathML Core for browsers."""

import re
import unicodedata
from collections.abc import Iterator
from functools import cache
from html import unescape
from importlib.metadata import PackageNotFoundError, version
from xml.etree.ElementTree import Element, tostring

from lagrotor.paper.latex.tokens import tokenize

_ACCENTS = dict(zip("→^ˆ˙¨¯‾―~∼˜", "→ˆˆ˙¨¯¯¯˜˜˜", strict=True))
_RELATIONS = "=≠≡≈∼<>≤≥≪≫→⇒∈"
_SIGNS = "+-−±∓"
_OPEN, _CLOSE = "([{⟨", ")]}⟩"
_NAMES = "sin cos tan exp log arcsin arctan artanh arcosh arsinh tanh sech cosh sinh".split(" ")  # noqa: SIM905
# The converter recognizes a style only before braces.
_STYLE = re.compile(r"\\(mathcal|mathrm|mathbf|mathbb)\s+(\w)")
_SCRIPTS = ("msub", "msup", "msubsup", "munder", "mover", "munderover", "mfrac", "mroot")
_PRIMES = "′″‴"
_THIN = "0.167em"


def converter() -> str:
    """Return the version of latex2mathml; "" if it is not installed."""
    try:
        return version("latex2mathml")
    except PackageNotFoundError:
        return ""


def mathml(source: str, display: bool = True) -> str | None:
    """Return LaTeX as `<math>` elements; None if latex2mathml is missing or fails.

    A displayed formula becomes one element per line; wide spaces separate its lines.
    """
    try:
        return _convert(source, display)
    except Exception:  # not installed, or unknown LaTeX, for which it raises errors of many kinds
        return None


@cache
def _convert(source: str, display: bool) -> str:
    from latex2mathml.converter import Converter

    lines = []
    for line in _lines(source) if display else [source]:
        plain = _STYLE.sub(r"\\\1{\2}", line.replace("{aligned}", "{align*}"))
        tree = Converter(display="block" if display else "inline").convert_to_element(plain)
        for node in tree.iter():
            node.text, node.tail = unescape(node.text or ""), None
            if not node.get("href", "https://").startswith(("https://", "http://")):
                del node.attrib["href"]  # links to pages remain, links that could run code do not
        _tidy(tree)
        _keep_readable(tree, 0, compact=not display)
        element = Element("math", {"display": "block"} if display else {})
        element.extend(tree)
        lines.append(tostring(element, encoding="unicode"))
    return "".join(lines)


def _lines(source: str) -> Iterator[str]:
    """Yield the lines of a source, separated by wide spaces outside braces and environments."""
    depth, line = 0, ""
    opening = {r"\begin": 1, r"\end": -1, r"\left": 1, r"\right": -1}
    for token in tokenize(source):
        depth += {"open": 1, "close": -1}.get(token.kind, 0) + opening.get(token.text, 0)
        is_break = token.text == r"\quad" or (token.text == "\\ " and line.endswith(";"))
        if is_break and depth == 0:
            yield from [line] if line.strip() else []
            line = ""
        else:
            line += token.text
    yield line


def _tidy(element: Element) -> None:
    """Adapt accents, signs, spaces and styles in place so that browsers draw them like TeX."""
    previous: Element | None = None
    for child in list(element):
        _tidy(child)
        text = child.text or ""
        if child.tag == "mstyle":
            child.tag = "mrow"
        if child.tag == "mtext" and not text.strip("\u00a0 "):
            child.tag, child.text = "mspace", None
            child.set("width", "0.25em")
        if child.tag in ("mi", "mo", "mn"):
            _leaf(child, text, previous)
        if child.tag in ("mover", "munder") and len(child) == 2 and (child[1].text or "") in _ACCENTS:
            _accent(child)
        if child.tag == "mtable":
            child.set("displaystyle", "true")
        if child.tag in ("msup", "msubsup"):
            _raise_prime(child)
        if element.tag in _SCRIPTS:
            continue
        if _is_function_name(child) and previous is not None and previous.tag not in ("mo", "mspace"):
            _space(element, child)
        follows_name = previous is not None and _is_function_name(previous)
        if follows_name and child.tag not in ("mo", "mspace") and not _is_bracket(child):
            _space(element, child)
        previous = child


def _keep_readable(element: Element, depth: int, compact: bool) -> None:
    """Let browsers draw the scripts of scripts as large as scripts. The element is changed in place.

    depth: the script level of the element, at most 1. compact: True if it is not in display style.
    """
    for place, child in enumerate(element):
        fraction = element.tag == "mfrac"
        script = element.tag in _SCRIPTS and not fraction and place > 0 and "accent" not in element.attrib
        below = depth + (compact if fraction else script)
        if below > 1:
            child.set("scriptlevel", "1")
        style = child.get("displaystyle")
        set_small = style == "false" if style else compact or fraction or script
        _keep_readable(child, min(below, 1), set_small)


def _leaf(child: Element, text: str, previous: Element | None) -> None:
    variant = child.attrib.pop("mathvariant", "")
    if variant and variant != "normal":
        child.text = "".join(
            _styled_letter(letter, variant.upper().replace("BOLD-ITALIC", "BOLD ITALIC")) for letter in text
        )
    elif variant or (child.tag == "mi" and len(text) == 1 and text in "ΓΔΘΛΞΠΣΥΦΨΩ∞"):
        child.set("mathvariant", "normal")
    if child.tag == "mo" and text in _SIGNS:
        child.text = "−" if text == "-" else text
        operator = (previous.text or "") if previous is not None and previous.tag == "mo" else None
        is_prefix = operator is not None and operator in _RELATIONS + _OPEN + ","
        first = previous is None or previous.tag == "mspace" or is_prefix
        child.set("form", "prefix" if first else "infix")
    elif child.tag == "mo" and text in ("/", ".", ",", ";", "*"):
        child.text = "∗" if text == "*" else text
        child.set("lspace", "0")
        child.set("rspace", "0" if text in "/*" else _THIN)
    elif text in ("~", "∼"):
        child.tag, child.text = "mo", "∼"
        child.attrib |= {"lspace": "0.278em", "rspace": "0.278em"}


def _raise_prime(child: Element) -> None:
    """Keep a prime from being raised twice, and set a power of an accented letter as high as a power of a plain letter."""
    if child.tag == "msup" and (child[1].text or "x") in _PRIMES:
        child.tag, child[1].attrib = "mrow", {"form": "postfix", "lspace": "0", "rspace": "0"}
    elif child[0].tag == "mover":
        base = Element("mpadded", {"height": ".6em"})
        base.append(child[0])
        child[0] = base


def _accent(child: Element) -> None:
    child.set("accent" if child.tag == "mover" else "accentunder", "true")
    mark = child[1]
    mark.tag, mark.text = "mo", _ACCENTS[mark.text or ""]
    mark.attrib = {"stretchy": "false"}
    if mark.text == "→":  # the unscaled arrow is wider than a letter
        mark.set("style", "font-size: .65em")


def _is_function_name(element: Element) -> bool:
    """Return True if an element is the name of a function such as sin, perhaps with a power or an index."""
    core = element[0] if element.tag in ("msup", "msub") and len(element) else element
    return core.tag in ("mi", "mo") and (core.text or "").strip() in _NAMES


def _is_bracket(element: Element) -> bool:
    first = element[0] if element.tag in ("mrow", "msup") and len(element) else element
    first = first[0] if first.tag == "mrow" and len(first) else first
    return first.tag == "mo" and (first.text or "") in _OPEN


def _space(parent: Element, child: Element) -> None:
    parent.insert(list(parent).index(child), Element("mspace", {"width": _THIN}))


def _styled_letter(character: str, style: str) -> str:
    """Return the bold or double-struck form of a character, because MathML Core has no attribute for these styles."""
    name = unicodedata.name(character, "").replace("LATIN ", "").replace("GREEK ", "").replace(" LETTER", "")
    try:
        return unicodedata.lookup(f"MATHEMATICAL {style} {name}")
    except KeyError:
        return character
