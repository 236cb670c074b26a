r"""Definitions of commands: \newcommand, \def, \let, \NewDocumentCommand, \DeclarePairedDelimiter …"""

from collections.abc import Iterable
from dataclasses import replace
from itertools import chain, pairwise

from lagrotor.paper.latex.expansion import Expander, Primitive
from lagrotor.paper.latex.groups import Macro, numbered
from lagrotor.paper.latex.tokens import Token, latex_of, plain, tokenize

HEADINGS = (r"\part", r"\chapter", r"\section", r"\subsection", r"\subsubsection")


def _defined(expander: Expander, token: Token) -> bool:
    expander.star()
    expander.skip_spaces()
    named = expander.argument()
    count = expander.optional()
    default = expander.optional() if count is not None else None
    body = expander.argument()
    name = next((t.text for t in named if t.kind == "command"), "")
    known = (expander.macros, expander.packages, expander.primitives, HEADINGS)
    if not name or (token.text == r"\providecommand" and any(name in each for each in known)):
        return True
    if _is_kept(expander, name, body):
        return True
    expander.macros[name] = Macro(tuple(body), numbered(count), None if default is None else tuple(default))
    return True


def _document_command(expander: Expander, token: Token) -> bool:
    named, spec, body = expander.argument(), latex_of(expander.argument()), expander.argument()
    if named:
        expander.macros[named[0].text] = Macro(tuple(body), spec=spec.strip() or " ")
    return True


def _def(expander: Expander, token: Token) -> bool:
    target = next_name(expander)
    head: list[Token] = []
    while (part := expander.next()) is not None and part.kind != "open":
        head.append(part)
    body = expander.group(token.at)
    by_lines = any(a.text == b.text == "^" for a, b in pairwise(head))  # ^^M: it reads lines as they stand
    if target is not None and target.kind == "command" and not by_lines and not _is_kept(expander, target.text, body):
        if token.text in (r"\edef", r"\xdef"):  # a command that is not known yet cannot stand for itself
            body = [part for part in expander.expand(body) if part.text != target.text]
        macro = Macro(tuple(body), tuple(head))
        if token.text in (r"\gdef", r"\xdef"):
            expander.macros.define_globally(target.text, macro)
        else:
            expander.macros[target.text] = macro
    return True


def _let(expander: Expander, token: Token) -> bool:
    target, source = next_name(expander), next_name(expander)
    if source is not None and source.text.startswith("="):
        expander.push(plain(source.text[1:].lstrip(), source.at))
        source = next_name(expander)
    if source is not None and source.kind == "text" and len(source.text) > 1:
        expander.push([Token("text", source.text[1:], source.at + 1)])
        source = Token("text", source.text[0], source.at)
    if target is not None and source is not None and target.kind == "command":
        known = expander.macros.get(source.text)
        if known is not None:
            expander.macros[target.text] = known
        elif source.kind == "command" and source.text in expander.packages:
            expander.macros.pop(target.text, None)
            expander.own[target.text] = expander.packages[source.text]
        elif source.text != target.text:
            kind = "primitive" if source.kind == "command" else source.kind
            expander.macros[target.text] = Macro((Token(kind, source.text, source.at),))
    return True


def _extended(expander: Expander, token: Token) -> bool:
    r"""\g@addto@macro\appendix{…}, \apptocmd{\appendix}{…}{}{}, \pretocmd: more behind or before what a command does."""
    named, added = expander.argument(), expander.argument()
    if token.text.endswith("tocmd"):
        expander.argument(), expander.argument()
    if named and named[0].kind == "command":
        known = expander.macros.get(named[0].text) or Macro((Token("primitive", named[0].text, token.at),))
        parts = (added, known.body) if token.text.startswith(r"\pre") else (known.body, added)
        expander.macros.define_globally(named[0].text, replace(known, body=tuple(chain(*parts))))
    return True


def _named(expander: Expander, token: Token) -> bool:
    expander.push([token])
    made = next_name(expander)
    expander.push([made] if made else [])
    return True


def next_name(expander: Expander) -> Token | None:
    r"""The command that is defined next, \csname … \endcsname too."""
    expander.skip_spaces()
    while (token := expander.next()) is not None and token.text == r"\expandafter":
        expander.skip_spaces()
    if token is None or token.text != r"\csname":
        return token
    name: list[Token] = []
    while (part := expander.next()) is not None and part.text != r"\endcsname":
        name.append(part)
    return Token("command", "\\" + latex_of(expander.expand(name)).strip(), token.at)


def _is_kept(expander: Expander, name: str, body: list[Token]) -> bool:
    """Whether a class says by LaTeX's inner commands how a command looks whose meaning is known here, or reads ahead."""
    known = name in HEADINGS or name in expander.primitives
    return any(
        t.text in (r"\@setfontsize", r"\futurelet", r"\not@math@alphabet")
        or (known and ("@" in t.text or t.text == r"\secdef") and t.kind == "command")
        for t in body
    )


def _operator(expander: Expander, token: Token) -> bool:
    star = "*" if expander.star() else ""
    named, body = expander.argument(), expander.argument()
    if named:
        made = [Token("command", r"\operatorname", 0), *plain(star, 0), Token("open", "{", 0)]
        expander.macros[named[0].text] = Macro((*made, *body, Token("close", "}", 0)))
    return True


def _pair(expander: Expander, token: Token) -> bool:
    r"""\DeclarePairedDelimiter{\abs}{|}{|}; \DeclarePairedDelimiterX{\ip}[2]{<}{>}{#1,#2}."""
    named = expander.argument()
    head = numbered(expander.optional(), 1)
    left, right = expander.argument(), expander.argument()
    body = expander.argument() if token.text.endswith("X") else [Token("param", "#1", 0)]
    inside = [each for each in body if each.text != r"\delimsize"]
    made = Macro((*tokenize(r"\left"), *left, *inside, *tokenize(r"\right"), *right), head)

    def paired(expander: Expander) -> Iterable[Token]:
        if not expander.star():
            expander.optional()
        return expander.body(made, token)

    if named:
        expander.macros.pop(named[0].text, None)
        expander.own[named[0].text] = paired
    return True


_COMMANDS = r"\newcommand \renewcommand \providecommand \DeclareRobustCommand \newrobustcmd \renewrobustcmd"
_DOCUMENT_COMMANDS = (
    r"\NewDocumentCommand \RenewDocumentCommand \ProvideDocumentCommand \DeclareDocumentCommand "
    r"\NewExpandableDocumentCommand"
)
DEFINITIONS: dict[str, Primitive] = {
    **dict.fromkeys(_COMMANDS.split(), _defined),
    **dict.fromkeys((r"\def", r"\gdef", r"\edef", r"\xdef"), _def),
    **dict.fromkeys(_DOCUMENT_COMMANDS.split(), _document_command),
    **dict.fromkeys((r"\DeclarePairedDelimiter", r"\DeclarePairedDelimiterX"), _pair),
    **dict.fromkeys((r"\g@addto@macro", r"\appto", r"\gappto", r"\apptocmd", r"\preto", r"\pretocmd"), _extended),
    r"\csname": _named,
    r"\let": _let,
    r"\DeclareMathOperator": _operator,
}
