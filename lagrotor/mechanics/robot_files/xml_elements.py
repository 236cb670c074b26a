"""XML elements with their lines: numbers as rationals, angles as multiples of π where the digits say so, refusals in words.

The text is parsed by expat. A document type, and with it every entity, is refused, as is XInclude, so that a file opens no other.
"""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import sympy as sp

from lagrotor.errors import InputError, near
from lagrotor.files import path_of

Numbers = tuple[sp.Rational, ...]
_DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?")
_DEEPEST = 400  # nested elements
_LARGEST = 50_000_000  # bytes of a file


@dataclass(frozen=True, eq=False)
class Element:
    """An element with its file and line; `angles` collects sentences about angles that are read as multiples of π."""

    file: Path
    line: int
    tag: str
    attributes: dict[str, str]
    children: "list[Element]" = field(default_factory=list)

    def refusal(self, reason: str) -> InputError:
        """Return an error that names the file, the line, the element and the reason."""
        named = self.attributes.get("name") or self.attributes.get("joint") or ""
        return InputError(f"{self.file}, line {self.line}: <{self.tag}{f' {named!r}' if named else ''}>: {reason}")

    def all(self, *tags: str) -> "list[Element]":
        return [child for child in self.children if child.tag in tags]

    def one(self, tag: str) -> "Element | None":
        """Return the child with a tag, None without one; two of them are refused."""
        found = self.all(tag)
        if len(found) > 1:
            raise self.refusal(
                f"it has {len(found)} elements <{tag}>, and only one has a meaning: leave out the others"
            )
        return found[0] if found else None

    def text(self, name: str, default: str | None = None) -> str:
        if (value := self.attributes.get(name, default)) is None:
            raise self.refusal(f'the attribute {name} is missing: add {name}="…"')
        return value

    def numbers(self, name: str, count: int | Iterable[int], default: str | None = None) -> Numbers:
        """Return the decimals of an attribute as exact rationals; `count` says how many there must be."""
        text = self.text(name, default)
        counts = (count,) if isinstance(count, int) else tuple(count)
        if len(words := text.split()) not in counts:
            wanted = " or ".join(map(str, counts))
            raise self.refusal(f"{name}={text!r} has {len(words)} numbers: give {wanted}, separated by blanks")
        return tuple(self._rational(name, word) for word in words)

    def number(self, name: str, default: str | None = None, least: int | None = None) -> sp.Rational:
        (value,) = self.numbers(name, 1, default)
        if least is not None and value < least:
            raise self.refusal(f"{name}={self.text(name)!r} must be at least {least}: correct it")
        return value

    def _rational(self, name: str, word: str) -> sp.Rational:
        if not _DECIMAL.fullmatch(word):
            way = "expand the file with xacro first" if "$" in word else "write a finite decimal number"
            raise self.refusal(f"{name}={word!r} is no number: {way}")
        return sp.Rational(word)

    def angles(self, name: str, default: str, degrees: bool = False, notes: list[str] | None = None) -> list[sp.Expr]:
        """Return angles in rad. A multiple of π/12 that is written to five digits, and π/2 to three, becomes exact; `notes`
        then gets a sentence if the decimal differs from it."""
        if degrees:
            return [e * sp.pi / 180 for e in self.numbers(name, range(1, 5), default)]
        exact = []
        for word, value in zip(self.text(name, default).split(), self.numbers(name, range(1, 5), default), strict=True):
            exact.append(angle := as_multiple_of_pi(word, value))
            if notes is not None and angle.has(sp.pi) and float(angle) != float(value):
                notes.append(f"{self.file.name}, line {self.line}: the angle {word} is read as {angle}")
        return exact

    def check_attributes(self, known: str) -> None:
        """Refuse an attribute that looks like a misprint of a known one; files contain others, for other programs."""
        names = known.split()
        for name in self.attributes.keys() - {*names}:
            one_off = [
                k for k in names if len(k) == len(name) and sum(a != b for a, b in zip(k, name, strict=True)) == 1
            ]
            if meant := near(name, names) or f": {' or '.join(one_off)}?" * bool(one_off):
                raise self.refusal(f"the attribute {name} has no meaning{meant}")

    def check_children(self, known: str) -> "list[Element]":
        """Return the children with unknown tags. A tag that looks like a misprint of a known one is refused."""
        tags = known.split()
        unknown = [child for child in self.children if child.tag not in tags]
        for child in unknown:
            if meant := near(child.tag, tags):
                raise child.refusal(f"no such element is read inside <{self.tag}>{meant}")
        return unknown


def as_multiple_of_pi(word: str, value: sp.Rational) -> sp.Expr:
    """Return the multiple of π/12 of which a decimal is the rounded or cut off value; the decimal itself if there is none."""
    mantissa, _, exponent = word.lower().partition("e")
    last = sp.Rational(10) ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    significant = len(mantissa.lstrip("+-0.").replace(".", ""))
    for part, digits in ((2, 3), (12, 5)):
        exact = round(float(value) * part / math.pi) * sp.pi / part
        over = (abs(value) - abs(exact)).evalf(40)  # ≤ 0 if the decimal is cut off, not rounded
        if exact != 0 and significant >= digits and -last < over <= last / 2:
            return exact
    return value


def read_xml(path: str | Path) -> Element:
    """Parse an XML file; raise InputError for bad XML, for a document type and for XInclude."""
    file = path_of("path", path)
    try:
        if file.stat().st_size > _LARGEST:
            raise InputError(f"{file} has {file.stat().st_size} bytes, more than {_LARGEST}: it is no robot file")
        data = file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}: give a file that can be read") from None
    root: list[Element] = []
    opened: list[Element] = []
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(file, parser.CurrentLineNumber, tag, attributes)
        if tag.lower().startswith(("xi:", "xacro:")) or tag.endswith(":include"):
            raise element.refusal("the file needs another program: expand it with xacro or XInclude first")
        if len(opened) >= _DEEPEST:
            raise element.refusal(f"more than {_DEEPEST} elements are nested: this is no robot file")
        (opened[-1].children if opened else root).append(element)
        opened.append(element)

    def doctype(*_: Any) -> None:
        raise InputError(
            f"{file}, line {parser.CurrentLineNumber}: <!DOCTYPE …> can define entities, and none is read: leave it out"
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: opened.pop()
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise InputError(f"{file} is no XML: {error}: correct the file there") from None
    return root[0]
