r"""Conditions: \if… \else \fi, \ifthenelse, \IfValueTF, \@ifnextchar; what cannot be known is taken as false."""

import re
from collections.abc import Iterable, Iterator

from lagrotor.paper.latex.definitions import next_name
from lagrotor.paper.latex.expansion import NO_VALUE, Expander, Package, Primitive
from lagrotor.paper.latex.tokens import BRACES, Token, latex_of, plain, tokenize

_TRUE = ("iftrue", "ifmmode", "ifpdf", "ifPDFTeX")
_FALSE = ("iffalse", "ifdraft", "ifluatex", "ifxetex", "ifLuaTeX", "ifXeTeX")
_UNKNOWN = (
    "ifdim",
    "if",
    "ifcat",
    "ifodd",
    "ifdefined",
    "ifcsname",
    "ifvmode",
    "ifhmode",
    "ifinner",
    "ifeof",
)
_JOINTS = r"NOT|AND|OR|not|and|or"
_GROUP = r"\s*\{((?:[^{}]|\{[^{}]*\})*)\}"
_TEST = re.compile(
    rf"\\(?P<joint>(?:{_JOINTS})(?![A-Za-z])|[()])|\\boolean\s*\{{(?P<flag>[^{{}}]*)\}}"
    r"|\\isundefined\s*\{?\s*(?P<name>\\[A-Za-z@]+)\s*\}?"
    rf"|\\equal{_GROUP.replace('(', '(?P<one>', 1)}{_GROUP.replace('(', '(?P<other>', 1)}"
    rf"|(?P<rest>(?:(?!\\(?:{_JOINTS})(?![A-Za-z])|\\[()]).)+)",
    re.DOTALL,
)
_LEVELS = ("part", "section", "subsection", "subsubsection", "appendix")
_NO_CONDITIONS = ("iff", "ifthenelse", "ifstrempty", "ifbool", "iftoggle", "ifblank", "ifdef", "ifstrequal")


def _condition(expander: Expander, token: Token) -> bool:
    r"""Take the branch of \if…: what cannot be known is taken as false."""
    name = token.text[1:]
    if name in expander.flags:
        holds = expander.flags[name]
    elif name == "ifnum":
        holds = _compared(expander)
    elif name == "ifx":
        by_name = (after := expander.peek()) is not None and after.text == r"\csname"
        first, second = next_name(expander), next_name(expander)
        holds = first is not None and second is not None and _same(expander, first, second)
        if by_name and first is not None and second is not None and second.text == r"\relax":
            holds = holds or not _is_known(expander, first.text)  # \csname gives \relax where nothing is defined
    else:
        holds = name in _TRUE
        if name in _UNKNOWN:
            expander.notes.append(rf"\{name} is taken as false")
    if not holds:
        _skip_to(expander, ("else", "fi"), token)
    return True


def _case(expander: Expander, token: Token) -> bool:
    r"""\ifcase n … \or … \else … \fi: branch n, from 0."""
    given = expander.argument()
    if latex_of(given) == r"\value":
        given += tokenize(f"{{{expander.name()}}}")
    shown = latex_of(expander.expand(given)).strip()
    known = shown.isdecimal() or any(each.text.startswith(r"\c@") for each in given)
    if not known:
        expander.notes.append(r"\ifcase is taken as false")
        _skip_to(expander, ("else", "fi"), token)
        return True
    for _ in range(expander.number(given)):
        if _skip_to(expander, ("or", "else", "fi"), token) != "or":
            break

    def other(expander: Expander) -> Iterable[Token]:
        _skip_to(expander, ("fi",), token)
        return ()

    expander.own[r"\or"] = other
    return True


def _else(expander: Expander, token: Token) -> bool:
    _skip_to(expander, ("fi",), token)
    return True


def _compared(expander: Expander) -> bool:
    """Whether two numbers compare as \\ifnum says; what they are made of is taken."""
    found: list[Token] = []
    depth = 0
    while len(found) < 13 and (token := expander.next()) is not None:
        depth += BRACES.get(token.kind, 0)
        if token.text in (r"\else", r"\fi", r"\or") or depth < 0:  # none is part of a number
            expander.push([token])
            break
        found.append(token)
        if token.text in (r"\relax", r"\z@", r"\@ne", r"\tw@") or re.search(r"[<>=]\s*-?\d+\s", token.text):
            break
    left, sign, right = re.match(r"([^<>=]*)([<>=]?)(.*)", latex_of(found), re.DOTALL).groups()  # type: ignore[union-attr]
    if not sign:
        expander.push(found)
        expander.notes.append(r"\ifnum is taken as false")
        return False
    if digits := re.match(r"\s*-?\d+\s?", right):
        rest, right = right[digits.end() :], digits[0]
        expander.push(tokenize(rest, found[-1].at + len(found[-1].text) - len(rest)))
    a, b = (expander.number(tokenize(side)) for side in (left, right))
    return {"<": a < b, ">": a > b, "=": a == b}[sign]


def _same(expander: Expander, first: Token, second: Token) -> bool:
    a, b = expander.macros.get(first.text), expander.macros.get(second.text)
    if a is not None and b is not None:
        return [t[:2] for t in a.body] == [t[:2] for t in b.body]
    return a is None and b is None and first.text == second.text


def _is_known(expander: Expander, name: str) -> bool:
    """Whether a command is defined by the source, or by LaTeX as far as this is known."""
    if name == r"\chapter":
        return expander.counters.chapters
    package = name.removeprefix(r"\ver@").removesuffix(".sty")
    defined = (expander.macros, expander.own, expander.packages, expander.primitives)
    return package in expander.loaded or any(name in each for each in defined) or name[1:] in _LEVELS


def _skip_to(expander: Expander, ends: tuple[str, ...], condition: Token) -> str:
    """Leave out tokens to the \\else or \\fi of this condition, and say which it was."""
    depth = 0
    while (token := expander.next()) is not None:
        if token.kind != "command":
            continue
        word = token.text[1:]
        if depth == 0 and word in ends:
            return word
        if word == "fi":
            depth -= 1
        elif word.startswith("if") and word not in _NO_CONDITIONS:
            depth += 1
    expander.macros.fault(condition.at, condition.text, rf"{condition.text} has no \fi: what follows is left out")
    return ""


def _if_value(expander: Expander, token: Token) -> bool:
    r"""\IfValueTF, \IfNoValueT, \IfBooleanTF: of an argument of \NewDocumentCommand."""
    tested = expander.argument()
    if token.text.startswith(r"\IfBoolean"):
        holds = latex_of(tested).strip() == "*"
    else:
        holds = (NO_VALUE in tested) == token.text.startswith(r"\IfNoValue")
    ending = re.search("T?F?$", token.text)[0]  # type: ignore[index]
    branches = {letter: expander.argument() for letter in ending}
    expander.push(branches.get("T" if holds else "F", ()))
    return True


def _if_then_else(expander: Expander, token: Token) -> bool:
    r"""\ifthenelse{\boolean{long}\AND\equal{…}{…}}{…}{…}; what cannot be known is taken as false."""
    test, yes, no = latex_of(expander.argument()).strip(), expander.argument(), expander.argument()
    holds = _joined(_tests(expander, test))
    if holds is None:
        expander.notes.append(rf"\ifthenelse{{{test}}} is taken as false")
    expander.push(yes if holds else no)
    return True


def _joined(tests: Iterator[bool | str | None]) -> bool | None:
    """Tests joined by AND and OR from left to right, in brackets; None: not known."""
    whole: bool | None = False
    joint, denied = "OR", False
    for test in tests:
        if test == ")":
            break
        if test == "NOT":
            denied = not denied
        elif test in ("AND", "OR"):
            joint = str(test)
        else:
            value = _joined(tests) if test == "(" else test
            parts = (whole, value if value is None else bool(value) != denied)
            decides = joint == "OR"
            whole = decides if decides in parts else None if None in parts else not decides
            denied = False
    return whole


def _tests(expander: Expander, text: str) -> Iterator[bool | str | None]:
    """The tests that \\ifthenelse joins, and what joins them; None for what cannot be known."""

    def shown(source: str) -> str:
        return latex_of(expander.expand(tokenize(source))).strip()

    for found in _TEST.finditer(text):
        if found["joint"]:
            yield found["joint"].upper()
        elif found["flag"]:
            yield expander.flags.get(f"if{found['flag']}", f"if{found['flag']}" in _TRUE)
        elif found["name"]:
            yield not _is_known(expander, found["name"])
        elif found["one"] is not None:
            yield shown(found["one"]) == shown(found["other"])
        elif sides := re.fullmatch(r"([^<>=]*)([<>=])([^<>=]*)", found["rest"]):
            a, b = (shown(sides[place]) for place in (1, 3))
            numbers = a.lstrip("-").isdecimal() and b.lstrip("-").isdecimal()
            yield {"<": int(a) < int(b), ">": int(a) > int(b), "=": a == b}[sides[2]] if numbers else None
        elif found["rest"].strip():
            yield None


def _if_next(expander: Expander, token: Token) -> bool:
    r"""\@ifnextchar[{…}{…} and \@ifstar{…}{…}: what comes next says which of the two."""
    wanted = latex_of(expander.argument()).strip() if token.text == r"\@ifnextchar" else "*"
    first, second = expander.argument(), expander.argument()
    expander.skip_spaces()
    after = expander.peek()
    comes = after is not None and latex_of([after]).startswith(wanted)
    if comes and token.text == r"\@ifstar":
        expander.star()
    expander.push(first if comes else second)
    return True


def _if_defined(expander: Expander, token: Token) -> bool:
    r"""\@ifundefined{name}{…}{…}, \@ifpackageloaded{…}{…}{…}, \@ifclassloaded{…}{…}{…}."""
    name = latex_of(expander.expand(expander.argument())).strip()
    first, second = expander.argument(), expander.argument()
    if token.text == r"\@ifclassloaded":
        holds = name in (expander.document_class, *expander.loaded)
    elif token.text == r"\@ifpackageloaded":
        holds = name in expander.loaded
    else:
        counted = name.startswith("c@") and name[2:] in expander.counters.values
        holds = not counted and not _is_known(expander, rf"\{name}")
    expander.push(first if holds else second)
    return True


def _loop(expander: Expander, token: Token) -> bool:
    r"""\loop … \repeat is left out."""
    while (passed := expander.next()) is not None and passed.text != r"\repeat":
        pass
    return True


def _heading(expander: Expander, token: Token) -> bool:
    r"""\secdef\numbered\starred before *{…}, [short]{…} or {…}: the one that takes the heading."""
    numbered, starred = expander.argument(), expander.argument()
    if expander.star():
        expander.push(starred)
        return True
    short = expander.optional()
    heading = expander.argument()
    before = heading if short is None else short
    inside = [Token("open", "{", token.at), *heading, Token("close", "}", token.at)]
    expander.push([*numbered, *plain("[", token.at), *before, *plain("]", token.at), *inside])
    return True


def _boolean(expander: Expander, token: Token) -> bool:
    name = f"if{expander.name()}"
    set_flag(expander, name, token.text == r"\setboolean" and expander.name() == "true")
    return True


def _new_flag(expander: Expander, token: Token) -> bool:
    expander.skip_spaces()
    if (named := expander.next()) is not None and named.text.startswith(r"\if"):
        set_flag(expander, named.text[1:], False)
    return True


def set_flag(expander: Expander, name: str, value: bool) -> None:
    r"""\draftfalse and \drafttrue set \ifdraft from now on."""

    def setter(value: bool) -> Package:
        def take(expander: Expander) -> Iterable[Token]:
            expander.flags[name] = value
            return ()

        return take

    expander.flags[name] = value
    expander.own |= {rf"\{name[2:]}true": setter(True), rf"\{name[2:]}false": setter(False)}


CONDITIONS: dict[str, Primitive] = {
    **{rf"\{name}": _condition for name in (*_TRUE, *_FALSE, *_UNKNOWN, "ifnum", "ifx")},
    **dict.fromkeys(
        [rf"\If{test}{ending}" for test in ("Value", "NoValue", "Boolean") for ending in ("T", "F", "TF")], _if_value
    ),
    **dict.fromkeys((r"\newboolean", r"\provideboolean", r"\setboolean"), _boolean),
    **dict.fromkeys((r"\@ifnextchar", r"\@ifstar"), _if_next),
    **dict.fromkeys((r"\@ifundefined", r"\ltx@ifundefined", r"\@ifpackageloaded", r"\@ifclassloaded"), _if_defined),
    r"\ifcase": _case,
    r"\secdef": _heading,
    r"\loop": _loop,
    r"\else": _else,
    r"\fi": lambda expander, token: True,
    r"\ifthenelse": _if_then_else,
    r"\newif": _new_flag,
}
