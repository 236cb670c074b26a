r"""Commands that set and print counters: \setcounter, \numberwithin, \arabic …"""

import re

from lagrotor.paper.latex.counters import Counters
from lagrotor.paper.latex.expansion import Expander, Primitive
from lagrotor.paper.latex.tokens import Token, latex_of, plain, tokenize


def _counted(expander: Expander, token: Token) -> bool:
    c, name = expander.counters, token.text
    star, style = expander.star(), expander.optional()
    counter = expander.name()
    if name == r"\newcounter":
        c.add(counter, latex_of(expander.optional() or ()).strip())
    elif name == r"\setcounter":
        c.values[counter] = expander.number(expander.argument())
    elif name == r"\addtocounter":
        c.values[counter] = c.values.get(counter, 0) + expander.number(expander.argument())
    elif name in (r"\stepcounter", r"\refstepcounter"):
        known = not counter.startswith("\\")  # \@captype: figure or table
        c.step(counter)
        if name == r"\refstepcounter":
            expander.stepped = expander.printed(counter) if known else ""
            expander.refer(expander.stepped)
    elif name == r"\@addtoreset":
        c.reset_by(counter, expander.name())
    elif name == r"\counterwithout":
        c.free(counter, expander.name())
        expander.macros.pop(rf"\the{counter}", None)
    else:
        c.reset_by(counter, parent := expander.name())
        if not star:
            expander.macros.pop(rf"\the{counter}", None)
            c.within[counter] = parent, latex_of(style or ()).strip().lstrip("\\") or "arabic"
    return True


def _shown(expander: Expander, token: Token) -> bool:
    name = expander.name()
    value = expander.counters.values.get(name)
    if value is None:
        expander.push(tokenize(f"{{{name}}}", token.at))
        return False
    expander.push(plain(Counters.style(value, token.text[1:]), token.at))
    return True


def _numbered(expander: Expander, token: Token) -> bool:
    r"""\@arabic\c@equation and \number\value{section} as classes write them."""
    if not any(map(expander.begins, (r"\c@", r"\value", "{"))):
        return False
    given = expander.argument()
    by_name = latex_of(given).strip() == r"\value"
    value = expander.counters.values.get(expander.name(), 0) if by_name else expander.number(given)
    expander.push(plain(Counters.style(value, token.text.lstrip("\\@").replace("number", "arabic")), token.at))
    return True


def _register(expander: Expander, token: Token) -> bool:
    r"""\c@chapter = 0, \c@chapter\z@, \advance\c@equation by 1, as classes write them."""
    values, advanced = expander.counters.values, token.text == r"\advance"
    if advanced:
        expander.skip_spaces()
        if not expander.begins(r"\c@") or (token := expander.argument()[0]).text[3:] not in values:
            return False
    expander.skip_spaces()
    for sign in "by" if advanced else "=":
        expander.star(sign)
    expander.skip_spaces()
    if (after := expander.peek()) is None or not re.match(r"[-+\d]|\\(?:c@|value|z@|@ne|tw@|m@ne)", after.text):
        return advanced
    given = expander.argument()
    while latex_of(given)[-1:] in "-+0123456789" and (digit := expander.peek()) and digit.text[:1].isdigit():
        given += expander.argument()
    if latex_of(given) == r"\value":
        given += tokenize(f"{{{expander.name()}}}")
    values[token.text[3:]] = expander.number(given) + (values[token.text[3:]] if advanced else 0)
    return True


def _value(expander: Expander, token: Token) -> bool:
    expander.push(plain(str(expander.counters.values.get(expander.name(), 0)), token.at))
    return True


_SETTING = (
    r"\newcounter \setcounter \addtocounter \stepcounter \refstepcounter \@addtoreset \numberwithin \counterwithin "
    r"\counterwithout"
)
COUNTING: dict[str, Primitive] = {
    **dict.fromkeys(_SETTING.split(), _counted),
    **dict.fromkeys((r"\arabic", r"\roman", r"\Roman", r"\alph", r"\Alph"), _shown),
    **dict.fromkeys((r"\@arabic", r"\@roman", r"\@Roman", r"\@alph", r"\@Alph", r"\number", r"\the"), _numbered),
    r"\value": _value,
    r"\c@": _register,
    r"\advance": _register,
}
