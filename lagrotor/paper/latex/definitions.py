"""Commands of LaTeX that define macros, choose between branches and include files."""

from lagrotor.paper.latex.macros import Expander, Macro, Parameter, Primitive, head_of
from lagrotor.paper.latex.tokens import Token, latex_of, plain

HEADINGS = (r"\part", r"\chapter", r"\section", r"\subsection", r"\subsubsection")
# Environments of displayed formulas: LaTeX's and amsmath's.
DISPLAYS = ("equation", "align", "gather", "multline", "eqnarray", "flalign", "alignat", "displaymath")


def _define(expander: Expander, name: str, macro: Macro, token: Token) -> None:
    """Define a name, unless its meaning is fixed: headings, definitions, counters and files."""
    if name in expander.primitives and name not in _REPLACEABLE:
        expander.notes.append(f"{expander.place(token.at)}: {name} is redefined: its standard meaning is used")
    elif name.startswith("\\") and name not in HEADINGS:
        expander.define(name, macro)


def _newcommand(expander: Expander, token: Token) -> None:
    expander.star()
    name, head, body = expander.name(), _head(expander), expander.argument()
    if token.text != r"\providecommand" or name not in (*expander.macros, *expander.primitives):
        _define(expander, name, Macro(tuple(body), head), token)


def _head(expander: Expander) -> tuple[Parameter, ...]:
    """Consume [number of arguments][default of the first]."""
    digits = latex_of(expander.optional() or ()).strip()
    head = [Parameter("m")] * (int(digits) if digits.isdecimal() and int(digits) < 10 else 0)
    if head and (default := expander.optional()) is not None:
        head[0] = Parameter("o", default=tuple(default))
    return tuple(head)


def _document_command(expander: Expander, token: Token) -> None:
    name, spec, body = expander.name(), latex_of(expander.argument()), expander.argument()
    _define(expander, name, Macro(tuple(body), head_of(spec)), token)


def _def(expander: Expander, token: Token) -> None:
    target = _next_name(expander)
    marks: list[Token] = []
    while (delimiter := expander.next()) is not None and delimiter.kind != "open":
        marks.append(delimiter)
    body, head = expander.group(token.at), tuple(Parameter("m") for mark in marks if mark.kind == "param")
    # \edef expands its body at once, and delimited arguments are not read: such a name becomes undefined
    if token.text in (r"\edef", r"\xdef") or len(head) < len([item for item in marks if item.text.strip()]):
        expander.define(target.text, None, everywhere=True)
    else:
        _define(expander, target.text, Macro(tuple(body), head), token)


def _let(expander: Expander, token: Token) -> None:
    target, source = _next_name(expander), _next_name(expander)
    if source.text.startswith("="):
        expander.push(plain(source.text[1:].lstrip(), source.at))
        source = _next_name(expander)
    if source.kind == "text":
        expander.push(plain(source.text[1:], source.at + 1))
        source = Token("text", source.text[:1], source.at)
    same = source._replace(kind="primitive" if source.kind == "command" else source.kind)
    if target.text != source.text:
        macro = expander.macros.get(source.text) or Macro((same,))
        _define(expander, target.text, macro, token)


def _next_name(expander: Expander) -> Token:
    """Consume the next token and the space before it."""
    expander.skip_spaces()
    return expander.next() or Token("text", "", 0)


def _operator(expander: Expander, token: Token) -> None:
    star = "*" if expander.star() else ""
    name, body = expander.name(), latex_of(expander.argument())
    _define(expander, name, Macro.of(rf"\operatorname{star}{{{body}}}"), token)


def _pair(expander: Expander, token: Token) -> None:
    r"""Define \abs by \DeclarePairedDelimiter{\abs}{|}{|}; * and [\big] may precede the argument."""
    name, opening, closing = expander.name(), expander.name(), expander.name()
    _define(expander, name, Macro.of(rf"\left{opening}#3\right{closing}", "som"), token)


def _new_environment(expander: Expander, token: Token) -> None:
    r"""Define \x and \endx for \newenvironment{x}, as LaTeX does."""
    expander.star()
    name, head = expander.name(), _head(expander)
    begin, end = expander.argument(), expander.argument()
    expander.define(rf"\{name}", Macro(tuple(begin), head))
    expander.define(rf"\end{name}", Macro(tuple(end)))


def _new_theorem(expander: Expander, token: Token) -> None:
    r"""Note that \newtheorem{name}[equation]{Title} shares the counter of equations: such numbers are not followed."""
    expander.star()
    expander.name()
    if latex_of(expander.optional() or ()).strip() == "equation":
        expander.doubt = "theorems share the counter of equations"


def _begin(expander: Expander, token: Token) -> None:
    name = expander.name()
    if name != "document":
        expander.begin_group(name)
    command = _is_command(expander, token, name)
    begin = Token("command", rf"\{name}", token.at) if command else Token("begin", rf"\begin{{{name}}}", token.at)
    expander.push((begin,))


def _end(expander: Expander, token: Token) -> None:
    name = expander.name()
    end = Token("end", rf"\end{{{name}}}", token.at)
    if _is_command(expander, token, name):
        end = Token("command", rf"\end{name}" if rf"\end{name}" in expander.macros else r"\relax", token.at)
    expander.push((end, Token("scope", name, token.at)))


def _is_command(expander: Expander, token: Token, name: str) -> bool:
    macros = expander.macros if token.kind == "command" else ()
    return (rf"\{name}" in macros and rf"\end{name}" in macros) or name == "appendix"


def _condition(expander: Expander, token: Token) -> None:
    if token.text == r"\iftrue" or expander.skip((r"\else", r"\fi"), token) == r"\else":
        expander.branches += 1


def _else(expander: Expander, token: Token) -> bool:
    if not expander.branches:
        return not expander.in_formula
    expander.branches -= 1
    if token.text == r"\else":
        expander.skip((r"\fi",), token)
    return True


def _if_value(expander: Expander, token: Token) -> None:
    r"""Choose a branch of \IfValueTF, \IfNoValueT or \IfBooleanTF by an argument of \NewDocumentCommand."""
    tested = expander.name()
    holds = tested == "*" if "Boolean" in token.text else (tested == r"\NoValue") == ("NoValue" in token.text)
    ending = "TF" if token.text.endswith("TF") else token.text[-1]
    branches = {letter: expander.argument() for letter in ending}
    expander.push(branches.get("T" if holds else "F", ()))


def _text(expander: Expander, token: Token) -> bool:
    r"""Replace \mbox{…} and \textrm{…} by \text{…}."""
    if not expander.begins("{"):
        return False
    inside = expander.argument()
    words = (Token("open", "{", token.at), *inside, Token("close", "}", token.at))
    expander.push((Token("word", r"\text", token.at), *words))
    return True


def _use(expander: Expander, token: Token) -> None:
    r"""Load the known packages of \usepackage. A package file in the source's folder is not read."""
    expander.optional()
    for name in map(str.strip, expander.name().split(",")):
        expander.load(name)


def _input(expander: Expander, token: Token) -> None:
    expander.skip_spaces()
    following = expander.peek()
    if token.text == r"\input" and following is not None and following.kind == "text":
        name = following.text.split()[0]
        expander.take(name)
    else:
        name = expander.name()
    expander.read_file(name, token.at)


def _end_input(expander: Expander, token: Token) -> None:
    expander.end_file(token.at)


def _skip_name(expander: Expander, token: Token) -> None:
    r"""Skip the name of a condition in \newif\ifx, which is not decided."""
    expander.argument()


def _skip_argument(expander: Expander, token: Token) -> None:
    r"""Skip the argument of a command such as \titleformat or \tikzset."""
    expander.star()
    expander.argument()


def _commands(names: str, primitive: Primitive) -> dict[str, Primitive]:
    return dict.fromkeys((rf"\{name}" for name in names.split()), primitive)


_REPLACEABLE = _commands("mbox hbox textnormal textrm textit text", _text)
PRIMITIVES: dict[str, Primitive] = {
    **_REPLACEABLE,
    **_commands("newcommand renewcommand providecommand DeclareRobustCommand newrobustcmd", _newcommand),
    **_commands("NewDocumentCommand RenewDocumentCommand DeclareDocumentCommand", _document_command),
    **_commands("def gdef edef xdef", _def),
    **_commands("let", _let),
    **_commands("newenvironment renewenvironment", _new_environment),
    **_commands("newtheorem", _new_theorem),
    **_commands("newif", _skip_name),
    **_commands("DeclareMathOperator", _operator),
    **_commands("DeclarePairedDelimiter", _pair),
    **_commands("usepackage RequirePackage", _use),
    **_commands("input include subfile @input", _input),
    **_commands("begin", _begin),
    **_commands("end", _end),
    **_commands("iftrue iffalse", _condition),
    **_commands("else fi", _else),
    **{rf"\If{test}{end}": _if_value for test in ("Value", "NoValue", "Boolean") for end in ("T", "F", "TF")},
    **_commands("long protected outer relax protect expandafter makeatletter makeatother xspace", lambda *_: None),
    **_commands("titleformat titlespacing tikzset pgfkeys pgfplotsset", _skip_argument),
    **_commands("endinput", _end_input),
}
