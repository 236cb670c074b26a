r"""Environments: their definitions, what \begin{…} and \end{…} stand for, those that show what stands in them."""

from lagrotor.paper.latex.definitions import HEADINGS
from lagrotor.paper.latex.expansion import STYLES, Expander, Primitive
from lagrotor.paper.latex.groups import Macro, numbered
from lagrotor.paper.latex.tokens import Token, latex_of, tokenize

_VERBATIM = "VerbatimEnvironment verbatim @verbatim Verbatim lstlisting minted comment tcblisting"
_VERBATIM_COMMANDS = {rf"\{name}" for name in _VERBATIM.split()}


def _environment(expander: Expander, token: Token) -> bool:
    expander.star()
    name = expander.name()
    if token.text == r"\NewDocumentEnvironment":
        spec, begin, end = latex_of(expander.argument()), expander.argument(), expander.argument()
        expander.environments[name] = Macro(tuple(begin), spec=spec.strip() or " "), tuple(end)
        return True
    count = expander.optional()
    default = expander.optional() if count is not None else None
    begin, end = expander.argument(), expander.argument()
    if token.text == r"\renewenvironment" and r"\linenomath" in {part.text for part in begin}:
        return True  # with the numbers of lines in the margin: it stays what it is
    if latex_of(begin).strip().startswith(rf"\begin{{{name}}}"):
        return True  # in iopart: what it is follows as \def\indented
    if _VERBATIM_COMMANDS & {part.text for part in begin}:
        expander.verbatim.add(name)
    expander.environments[name] = (
        Macro(tuple(begin), numbered(count), None if default is None else tuple(default)),
        tuple(end),
    )
    return True


def _theorem(expander: Expander, token: Token) -> bool:
    r"""\newtheorem{name}[counter]{Title}[within]: an environment that counts."""
    if expander.star():
        return True
    name, shared = expander.name(), expander.optional()
    expander.argument()
    within = expander.optional()
    expander.theorems[name] = latex_of(shared).strip() if shared is not None else name
    if shared is None:
        parent = latex_of(within or ()).strip()
        expander.counters.add(name, parent)
        expander.counters.within[name] = parent, "arabic"
    return True


def _verbatim_environment(expander: Expander, token: Token) -> bool:
    r"""\lstnewenvironment, \DefineVerbatimEnvironment, \newminted, \newtcblisting, \excludecomment."""
    first = expander.optional()
    name = expander.name()
    if token.text == r"\newminted":
        name = latex_of(first).strip() if first else f"{name}code"
    expander.verbatim.add(name)
    parts = {r"\excludecomment": 0, r"\lstnewenvironment": 2, r"\DefineVerbatimEnvironment": 2}.get(token.text, 1)
    parts += token.text in (r"\DeclareTCBListing", r"\NewTCBListing")
    while expander.optional() is not None:
        pass
    for _ in range(parts):
        expander.argument()
    return True


def _begin(expander: Expander, token: Token) -> bool:
    name = expander.name()
    expander.stepped = ""  # what a label in the text refers to
    known = _environment_of(expander, name)
    if known is None and (command := _command_of(expander, name, "", token.at)):
        expander.macros.open(name, token.at)
        expander.push([command])
        return True
    if name in expander.verbatim and _pass_over(expander, name, token.at):
        return True
    if name not in ("document", ""):
        expander.macros.open(name, _own_place(expander, known, token))
    if known is None:
        if (counter := expander.theorems.get(name)) is not None:
            expander.counters.step(counter)
            expander.refer(expander.printed(counter))
        expander.push(tokenize(f"{{{name}}}", token.at))
        return False
    expander.count(rf"\begin{{{name}}}", token.at)
    expander.push(expander.body(known[0], token))
    return True


def _end(expander: Expander, token: Token) -> bool:
    name = expander.name()
    known = _environment_of(expander, name)
    if known is None and (command := _command_of(expander, name, "end", token.at)):
        expander.push([command, Token("scope", name, token.at)])
        return True
    if known is None:
        if name not in ("document", ""):
            expander.level = expander.macros.end_environment(name, token.at)
        expander.push(tokenize(f"{{{name}}}", token.at))
        return False
    expander.count(rf"\end{{{name}}}", token.at)
    scope = Token("scope", name, _own_place(expander, known, token))
    expander.push([*(Token(t.kind, t.text, token.at) for t in known[1]), scope])
    return True


def _environment_of(expander: Expander, name: str) -> tuple[Macro, tuple[Token, ...]] | None:
    known = None if expander.original else expander.environments.get(name)
    expander.original = False
    return known


def _pass_over(expander: Expander, name: str, at: int) -> bool:
    """Pass over an environment that shows what stands in it, where the source itself has it."""
    start, _, _, text = expander.file_of(at)
    ending = rf"\end{{{name}}}"
    place = text.find(ending, at - start)
    if place < 0 or not text.startswith(r"\begin", at - start):
        return False
    end = start + place + len(ending)
    expander.pass_over(start, end, text[end - start :])
    return True


def _own_place(expander: Expander, known: tuple[Macro, tuple[Token, ...]] | None, token: Token) -> int:
    """The place of a token; none where a package beside the source defines the environment and may end its parts."""
    parts = (*known[0].body, *known[1]) if known else ()
    return -1 if parts and expander.file_of(parts[0].at)[1].endswith(STYLES) else token.at


def _command_of(expander: Expander, name: str, verb: str, at: int) -> Token | None:
    r"""\begin{x} is \x where the source defines \x and \endx, and where \x is a heading or \appendix: \begin{chapter}{…}."""
    command = rf"\{verb}{name}"
    defined = rf"\{name}" in expander.macros and rf"\end{name}" in expander.macros
    return Token("command", command, at) if defined or command in (*HEADINGS, r"\appendix") else None


def _display(expander: Expander, token: Token) -> bool:
    r"""\align and \endalign, as definitions of environments have them: what \begin{align} and \end{align} are."""
    name = token.text[1:]
    verb, name = (r"\end", name[3:]) if name.startswith("end") else (r"\begin", name)
    expander.original = token.kind == "primitive"
    expander.push(tokenize(rf"{verb}{{{name}}}", token.at))
    return True


_NEW_VERBATIM = (
    r"\lstnewenvironment \DefineVerbatimEnvironment \newminted \newtcblisting \DeclareTCBListing \NewTCBListing "
    r"\excludecomment"
)
_DISPLAYS = ("equation", "align", "gather", "multline", "eqnarray", "flalign", "displaymath", "subequations")
ENVIRONMENTS: dict[str, Primitive] = {
    **dict.fromkeys((r"\newenvironment", r"\renewenvironment", r"\NewDocumentEnvironment"), _environment),
    **dict.fromkeys(_NEW_VERBATIM.split(), _verbatim_environment),
    **{rf"\{end}{name}": _display for name in _DISPLAYS for end in ("", "end")},
    r"\newtheorem": _theorem,
    r"\begin": _begin,
    r"\end": _end,
}
