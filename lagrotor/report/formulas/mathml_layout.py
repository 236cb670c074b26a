"""What both ways to MathML share: brackets, signs, accents and spaces as TeX sets them, in elements that browsers draw."""

import unicodedata
from collections.abc import Iterable
from xml.etree.ElementTree import Element

RELATIONS = frozenset("=≠≡≈∼<>≤≥≪≫→⇒∈")
SIGNS = frozenset("+−±∓")
_PAIRS = {"(": ")", "[": "]", "{": "}", "⟨": "⟩", "|": "|", "‖": "‖"}
_TALL = ("mfrac", "mtable", "msqrt", "mroot", "munder", "munderover")
_ACCENTS = dict(zip("→^ˆ˙¨¯‾―~∼˜", "→ˆˆ˙¨¯¯¯˜˜˜", strict=True))
_OPERATORS = {"-": "−", "*": "∗", "~": "∼"}
# As in TeX a slash and a full stop stand close, and Greek capitals upright.
_SPACES = {"/": "0", ",": "0.167em", ".": "0.167em", ";": "0.167em"}
_CAPITALS = frozenset("ΓΔΘΛΞΠΣΥΦΨΩ")
_PRIMES = ("′", "″", "‴")
_SCRIPTED = ("msub", "msup", "msubsup", "munder", "munderover")
_WITH_LIMITS = ("∑", "∏", "lim", "max", "min")
_LIMITS = {"msub": "munder", "msubsup": "munderover"}
_THIN = "0.167em"


def leaf(tag: str, text: str, **attributes: str) -> Element:
    """An element that holds text."""
    element = Element(tag, attributes)
    element.text = text
    return element


def join(tag: str, children: Iterable[Element], **attributes: str) -> Element:
    """An element that holds elements."""
    element = Element(tag, attributes)
    element.extend(children)
    return element


def row(items: list[Element]) -> Element:
    """One element for several: itself when it is alone."""
    return items[0] if len(items) == 1 else join("mrow", items)


def laid_out(elements: Iterable[Element]) -> list[Element]:
    """The items of one row, put right: rows within it opened, brackets paired, signs, spaces and accents set."""
    return _spaced(_signed(_paired([item for element in elements for item in _plain(element)])))


def _plain(element: Element) -> list[Element]:
    """An element in the words that browsers know; a row gives its items."""
    tag, text = element.tag, (element.text or "").strip(" \n")
    if tag in ("mrow", "mstyle") and not element.get("displaystyle"):
        return [item for child in element for item in _plain(child)]
    if tag == "mstyle":
        inside = row(laid_out(element))
        inside.set("displaystyle", element.get("displaystyle", ""))
        return [inside]
    if tag in ("mi", "mo", "mn"):
        return _letter(element, text)
    if tag == "mtext":
        return [leaf("mtext", text)] if text.strip("\u00a0") else [join("mspace", (), width="0.25em")]
    if tag == "mspace":
        return [join("mspace", (), width=element.get("width", "0"))]
    if tag in ("mtd", "msqrt"):
        side = element.get("columnalign")
        style = {"style": f"text-align: {side}"} if side else {}
        return [join(tag, [row(laid_out(element))] if len(element) else (), **style)]
    parts = [row(laid_out([child])) for child in element]
    if tag == "mover" and (mark := _ACCENTS.get(parts[1].text or "")):
        return [_accented(parts[0], mark)]
    if tag == "mtable":
        return [join(tag, parts, displaystyle="true")]
    return _scripts(tag, parts)


def _accented(base: Element, mark: str) -> Element:
    accent = leaf("mo", mark, stretchy=str(base.tag == "mrow").lower())
    if mark == "→":  # the whole arrow is wider than a letter
        accent.set("style", "font-size: .65em")
    return join("mover", (base, accent), accent="true")


def _scripts(tag: str, parts: list[Element]) -> list[Element]:
    """Scripts as TeX sets them: primes on the line, limits under a sum, no higher for an accent on what carries them."""
    scripts = 2 if tag == "msubsup" else 1
    if tag.startswith("ms") and len(parts) > scripts + 1:  # the converter leaves a bracketed base in pieces
        parts = [row(_paired(parts[:-scripts])), *parts[-scripts:]]
    base = parts[0]
    if tag == "msup" and parts[1].text in _PRIMES:
        return [base, leaf("mo", parts[1].text or "", form="postfix", lspace="0", rspace="0")]
    if tag == "msup" and base.tag == "msub":
        tag, parts = "msubsup", [*base, parts[1]]
    if base.text in _WITH_LIMITS and tag in _LIMITS:
        tag = _LIMITS[tag]
    elif base.tag == "mover" and tag != "msub":
        parts[0] = join("mpadded", [base], height=".6em")
    return [join(tag, parts)]


def _letter(element: Element, text: str) -> list[Element]:
    if text in ("", "\u2061", "\u2062", "\u2063"):
        return []
    variant = element.get("mathvariant", "normal").upper().replace("BOLD-ITALIC", "BOLD ITALIC")
    if variant != "NORMAL":
        return [leaf(element.tag, "".join(_styled(character, variant) for character in text))]
    if text == "∂" or (element.tag == "mo" and len(text) > 1 and text.isalpha()):
        return [leaf("mi", text)]
    if element.tag == "mo" or (element.tag == "mi" and not any(c.isalnum() or c == "∞" for c in text)):
        spaces = {"lspace": "0", "rspace": _SPACES[text]} if text in _SPACES else {}
        return [leaf("mo", _OPERATORS.get(text, text), **spaces)]
    given = "mathvariant" in element.attrib or text in _CAPITALS
    upright = {"mathvariant": "normal"} if element.tag == "mi" and len(text) == 1 and given else {}
    return [leaf(element.tag, text, **upright)]


def _styled(character: str, style: str) -> str:
    """A letter or digit in bold, double-struck …: browsers know no other `mathvariant` than normal."""
    name = unicodedata.name(character, "").replace("LATIN ", "").replace("GREEK ", "").replace(" LETTER", "")
    try:
        return unicodedata.lookup(f"MATHEMATICAL {style} {name}")
    except KeyError:
        return character


def bracketed(element: Element) -> bool:
    """Whether an element is a row in brackets."""
    return (
        element.tag == "mrow" and len(element) > 1 and element[0].text in _PAIRS and element[0].get("form") == "prefix"
    )


def core(element: Element) -> Element:
    """What carries the scripts of an element, or the element."""
    return core(element[0]) if element.tag in _SCRIPTED else element


def _paired(items: list[Element]) -> list[Element]:
    """Brackets and what is between them as one row."""
    open_rows: list[list[Element]] = [[]]
    for item in items:
        mark = core(item)
        opened = open_rows[-1][0].text if len(open_rows) > 1 else None
        if mark.tag == "mo" and opened is not None and mark.text == _PAIRS[opened]:
            inside = open_rows.pop()
            open_rows[-1].append(_bracket(inside[0], inside[1:], item))
        elif item is mark and mark.tag == "mo" and mark.text in _PAIRS:
            open_rows.append([item])
        else:
            open_rows[-1].append(item)
    return [item for items in open_rows for item in items]


def _bracket(left: Element, inside: list[Element], right: Element) -> Element:
    """A row in brackets; a script of the closing one is set at that bracket, or where they stretch at the row."""
    tall = any(True for item in inside for tag in _TALL for _ in item.iter(tag))
    left, mark = (leaf("mo", bracket.text or "", stretchy=str(tall).lower()) for bracket in (left, core(right)))
    left.set("form", "prefix")
    mark.set("form", "postfix")
    inside = _spaced(_signed([left, *inside]))
    if tall:
        return _on(right, join("mrow", (*inside, mark)))
    return join("mrow", (*inside, _on(right, mark)))


def _on(script: Element, base: Element) -> Element:
    """The scripts of an element on another base."""
    return base if script.tag == "mo" else join(script.tag, (_on(script[0], base), *script[1:]))


def _signed(items: list[Element]) -> list[Element]:
    """Signs distinguished: a plus or minus with nothing to its left is a prefix."""
    before: Element | None = None
    for item in items:
        if item.tag == "mo" and item.text in SIGNS:
            alone = before is None or before.tag in ("mo", "mspace")
            item.set("form", "prefix" if alone else "infix")
        before = item
    return items


def _spaced(items: list[Element]) -> list[Element]:
    """TeX's thin spaces: around fractions, before a function, and after it where no bracket follows."""
    spaced: list[Element] = []
    for item in items:
        before, after = (_kind(spaced[-1]) if spaced else ""), _kind(item)
        pair = {before, after}
        if before and after and (pair & {"function", "fraction"}) and (before, after) != ("function", "bracket"):
            spaced.append(join("mspace", (), width=_THIN))
        spaced.append(item)
    return spaced


def _kind(element: Element) -> str:
    """How an element asks for space: a function, a fraction, a bracket or a letter; operators bring their own."""
    inner = core(element)
    if inner.tag in ("mo", "mspace"):
        return ""
    if inner.tag == "mi" and len(inner.text or "") > 1:
        return "function"
    return "fraction" if element.tag == "mfrac" else "bracket" if bracketed(inner) else "letter"
