"""Numbers, with their unit, percent sign or degrees."""

import re
from fractions import Fraction

from lagrotor.paper.latex.boxes import Box, FormulaError
from lagrotor.paper.latex.formula_reader import FormulaReader
from lagrotor.paper.latex.read_scripts import power_of
from lagrotor.paper.latex.rows import DEGREES, UNITS
from lagrotor.paper.latex.tree import Call, Letter, Node, Number, number, product_of

_MOST_DIGITS = 1000
_UNIT = re.compile(r"[A-Za-zµ%]+|\^\{?-?\d+\}?|[/.~\s,·]|\\[,.%]|-?\d+|[{}]")


def read_number(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    box, behind = row[place], place + 1
    text = box.name
    after = next((b for b in row[behind:] if b.kind != "thin"), box)
    above = [b.name for b in box.sup or ()]
    if above == ["1"] or (above and after.kind == "letter" and "1" in (text, above[0])):  # 1^1 S_0
        reader.guess("power", f"{text} has a power, and is no sign of a term")
    if re.fullmatch(r"[1-9]\d{0,2}\.000", text):
        reader.guess("digits", f"the full stop in {text} is a decimal point, and parts no thousands")
    if len(text) > 1 and text.isdecimal() and text[0] == "0":
        reader.guess("digits", f"{text} is a number, and no row of digits")
    while (
        behind + 1 < len(row)
        and row[behind].kind == "thin"
        and row[behind + 1].kind == "number"
        and len(row[behind + 1].name) == 3
        and re.fullmatch(r"\d{1,3}(?:\d{3})*|\d+\.(?:\d{3})+", text)
        and box.sup is None
    ):
        box = row[behind + 1]
        text += box.name
        behind += 2
    node: Node = Number(_value(reader, text, box))
    if box.sub is not None:
        raise FormulaError(box.at, "a number has an index", "write the letter that it belongs to")
    if box.sup and len(box.sup) == 1 and box.sup[0].name in DEGREES:
        return _degrees(reader, row, behind, node, box)
    node = power_of(reader, node, box)
    unit = behind + 1 if behind < len(row) and row[behind].kind == "thin" else behind
    after = row[unit] if unit < len(row) else box
    if after.name in ("%", r"\%"):
        return Call("quotient", (node, number(100))), unit + 1
    if after.kind in ("unit", "text"):
        return product_of([node, _units(after)]), unit + 1
    factors = [node]
    while unit < len(row) and row[unit].upright and row[unit].name in UNITS and row[unit].sub is None:
        if unit == behind and len(row[unit].name) == 1 and len(factors) == 1:
            reader.guess("unit", f"upright {row[unit].name} behind a number is a unit")
        factors.append(power_of(reader, Letter(f"unit_{row[unit].name}"), row[unit]))
        behind = unit + 1
        unit = next((k for k in range(behind, len(row)) if row[k].kind != "thin"), len(row))
    if unit == len(row) - 1 and row[unit].upright and len(row[unit].name) > 1:
        reader.guess("unit", f"{row[unit].name} behind the number is a letter, and no unit")
    return product_of(factors), behind


def _degrees(reader: FormulaReader, row: list[Box], behind: int, node: Node, box: Box) -> tuple[Node, int]:
    """A number of degrees, of an angle or before C and F of a temperature."""
    if box.sup and box.sup[0].name == "o":
        reader.guess("unit", f"o above {box.name} means degrees")
    scale = next((k for k in range(behind, len(row)) if row[k].kind != "thin"), len(row))
    if scale < len(row) and row[scale].name in ("C", "F") and not row[scale].sub:
        if not (row[scale].upright or row[scale].kind == "text"):
            reader.guess("unit", f"{row[scale].name} behind a degree sign is a scale of temperature")
        return product_of([node, Letter(f"unit_deg{row[scale].name}")]), scale + 1
    return Call("quotient", (product_of([node, Letter("pi")]), number(180))), behind


def _value(reader: FormulaReader, text: str, box: Box) -> Fraction:
    if len(text) > _MOST_DIGITS:
        raise FormulaError(box.at, f"{text[:12]}…: a number has more than {_MOST_DIGITS} digits", "give it a letter")
    if "{,}" in text:
        whole, *groups = text.split("{,}")
        comma = reader.notation.decimal_comma
        if comma is None:
            comma = len(groups) == 1 and (len(groups[0]) != 3 or whole == "0")
            if not comma and len(groups) == 1:
                reader.guess("thousands", f"{text} is {whole}{groups[0]}, the comma parts thousands")
        if comma and len(groups) == 1 and "." not in text:
            return Fraction(f"{whole}.{groups[0]}")
        if not all(len(each.partition(".")[0]) == 3 for each in groups):
            raise FormulaError(box.at, f"{text} is no number", "write a decimal point")
        return Fraction(whole + "".join(groups))
    return Fraction(text)


def read_unit(reader: FormulaReader, row: list[Box], place: int) -> tuple[Node, int]:
    raise FormulaError(row[place].at, "upright letters are no letter of a formula", "write \\text{…} for words")


def _units(box: Box) -> Node:
    """A unit such as m/s^2 as letters unit_m, unit_s."""
    name = re.sub(r"/\(([^()/]*)\)$", r"/\1", box.name)  # kJ/(kg K)
    parts = _UNIT.findall(name)
    if "".join(parts).replace(" ", "") != name.replace(" ", "") or not parts:
        raise FormulaError(box.at, f"{box.name} is no unit", "write it as \\mathrm{m/s^2}")
    factors: list[Node] = []
    below = False
    for part in parts:
        if part == "/":
            if below:
                raise FormulaError(box.at, f"{box.name} has two slashes", "write powers")
            below = True
        elif part[0] in "^-" or part.isdigit():
            if not factors:
                raise FormulaError(box.at, f"{box.name} is no unit", "write it as \\mathrm{m/s^2}")
            power = number(int(part.strip("^{}")))
            last = factors[-1]
            inverse = isinstance(last, Call)
            base = last.args[0] if isinstance(last, Call) else last
            factors[-1] = Call("power", (base, Number(-power.value if inverse else power.value)))
        elif part[0].isalpha() or part[0] == "%":
            letter = Letter(f"unit_{part}")
            factors.append(Call("power", (letter, number(-1))) if below else letter)
    return product_of(factors)
