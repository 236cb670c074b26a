r"""Commands that set and print counters: \setcounter, \numberwithin, \arabic …"""

from lagrotor.paper.source.counters import Counters
from lagrotor.paper.source.expansion import Expander, Primitive
from lagrotor.paper.source.tokens import Token, latex_of, plain, tokenize


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
        c.step(counter)
        if name == r"\refstepcounter":
            expander.stepped = expander.printed(counter)
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
    **dict.fromkeys((r"\@arabic", r"\@roman", r"\@Roman", r"\@alph", r"\@Alph", r"\number"), _numbered),
    r"\value": _value,
}
