r"""Commands that set and print counters: \setcounter, \numberwithin, \arabic …"""

from lagrotor.paper.source.counters import Counters
from lagrotor.paper.source.expansion import Expander, Primitive
from lagrotor.paper.source.tokens import Token, latex_of, plain


def _counted(expander: Expander, token: Token) -> bool:
    c, name = expander.counters, token.text
    if name == r"\newcounter":
        counter = expander.name()
        within = expander.optional()
        c.add(counter, latex_of(within).strip() if within is not None else "")
    elif name == r"\setcounter":
        counter = expander.name()
        c.values[counter] = expander.number(expander.argument())
    elif name == r"\addtocounter":
        counter = expander.name()
        c.values[counter] = c.values.get(counter, 0) + expander.number(expander.argument())
    elif name in (r"\stepcounter", r"\refstepcounter"):
        counter = expander.name()
        c.step(counter)
        if name == r"\refstepcounter":
            expander.stepped = expander.printed(counter)
    elif name == r"\@addtoreset":
        counter = expander.name()
        c.reset_by(counter, expander.name())
    elif name in (r"\numberwithin", r"\counterwithin"):
        kept = expander.star() if name == r"\counterwithin" else False
        style = expander.optional()
        counter, parent = expander.name(), expander.name()
        shown = latex_of(style).strip() if style else r"\arabic"
        c.reset_by(counter, parent)
        if not kept:
            expander.macros.pop(rf"\the{counter}", None)
            c.within[counter] = parent, shown.lstrip("\\")
    elif name == r"\counterwithout":
        expander.star()
        expander.optional()
        counter, parent = expander.name(), expander.name()
        c.free(counter, parent)
        expander.macros.pop(rf"\the{counter}", None)
    return True


def _shown(expander: Expander, token: Token) -> bool:
    name = expander.name()
    value = expander.counters.values.get(name)
    if value is None:
        expander.push([Token("open", "{", token.at), Token("text", name, token.at), Token("close", "}", token.at)])
        return False
    expander.push(plain(Counters.style(value, token.text[1:]), token.at))
    return True


def _value(expander: Expander, token: Token) -> bool:
    expander.push(plain(str(expander.counters.values.get(expander.name(), 0)), token.at))
    return True


COUNTING: dict[str, Primitive] = {
    **dict.fromkeys(
        (
            r"\newcounter", r"\setcounter", r"\addtocounter", r"\stepcounter", r"\refstepcounter", r"\@addtoreset",
            r"\numberwithin", r"\counterwithin", r"\counterwithout",
        ),
        _counted,
    ),
    **dict.fromkeys((r"\arabic", r"\roman", r"\Roman", r"\alph", r"\Alph"), _shown),
    r"\value": _value,
}  # fmt: skip
