r"""The commands of TeX and LaTeX that act while a source is expanded."""

from lagrotor.paper.latex.conditions import CONDITIONS
from lagrotor.paper.latex.counter_commands import COUNTING
from lagrotor.paper.latex.definitions import DEFINITIONS
from lagrotor.paper.latex.environments import ENVIRONMENTS
from lagrotor.paper.latex.expansion import Expander, Primitive
from lagrotor.paper.latex.source_files import FILES
from lagrotor.paper.latex.tokens import Token, plain


def _ignored(expander: Expander, token: Token) -> bool:
    return True


def _ensured(expander: Expander, token: Token) -> bool:
    expander.push(expander.argument())
    return True


def _overlay(expander: Expander, token: Token) -> bool:
    r"""\uncover<2->{…} of beamer: what it shows, in which rows may end."""
    if expander.document_class != "beamer":
        return False
    expander.delimited("<", ">")
    expander.skip_spaces()
    expander.push(expander.argument() if expander.begins("{") else ())
    return True


def _of_titles(expander: Expander, token: Token) -> bool:
    r"""\titleformat\section[…]{…}: how a heading looks is none."""
    expander.star()
    expander.argument()
    return True


def _style(expander: Expander, token: Token) -> bool:
    r"""\tikzset{…} and \tikzstyle{name} = […]: what keys hold, {\begin{…}} too, is set in parts, in a picture."""
    expander.argument()
    expander.skip_spaces()
    if token.text == r"\tikzstyle" and (sign := expander.next()) is not None:
        expander.push(plain(sign.text.removeprefix("="), sign.at) if sign.text.startswith("=") else [sign])
        expander.optional()
    return True


_WITHOUT_EFFECT = (
    r"\long", r"\global", r"\protected", r"\outer", r"\relax", r"\protect", r"\expandafter", r"\makeatletter",
    r"\makeatother", r"\xspace",
)  # fmt: skip
PRIMITIVES: dict[str, Primitive] = {
    **CONDITIONS,
    **DEFINITIONS,
    **ENVIRONMENTS,
    **FILES,
    **COUNTING,
    **dict.fromkeys(_WITHOUT_EFFECT, _ignored),
    **dict.fromkeys((r"\tikzset", r"\tikzstyle", r"\pgfkeys", r"\pgfplotsset"), _style),
    **dict.fromkeys((r"\titleformat", r"\titlespacing"), _of_titles),
    **dict.fromkeys((r"\uncover", r"\only", r"\visible", r"\onslide"), _overlay),
    r"\ensuremath": _ensured,
}
