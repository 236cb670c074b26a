"""The parts of an expression, each once: a Lagrangian of 24 rods has 2,000 different parts, and 6×10⁸ where it is written out."""

from operator import is_
from threading import RLock
from typing import Any

import sympy as sp
from sympy.core.cache import clear_cache

_WRITTEN = 100_000  # parts of an expression up to which it is written out
_MOST = 200_000  # parts that are known at a time

# The parts known, by class and the identities of the arguments, or the part itself where it has none; the identities of those.
_KNOWN = dict[Any, sp.Basic]()
_OWN = set[int]()
_LOCK = RLock()


def subexpressions(*given: sp.Basic) -> list[sp.Basic]:
    """Every different part of expressions, after those that it is made of."""
    made = dict[sp.Basic, None]()
    left = [(e, False) for e in reversed(given)]
    while left:
        part, whole = left.pop()
        if whole:
            made[part] = None
        elif part not in made:
            left += [(part, True), *((a, False) for a in reversed(part.args))]
    return list(made)


def free_letters(e: sp.Basic) -> set[sp.Symbol]:
    """Its free symbols."""
    inside = dict[sp.Basic, set[sp.Symbol]]()
    for part in subexpressions(e):
        bound = getattr(part, "bound_symbols", ())
        inside[part] = part.free_symbols if part.is_Atom or bound else set().union(*(inside[a] for a in part.args))
    return inside[e]


def length(e: sp.Basic) -> int:
    """How many parts it has where all are written out."""
    counts = dict[sp.Basic, int]()
    for part in subexpressions(e):
        counts[part] = 1 + sum(counts[a] for a in part.args)
    return counts[e]


def written(e: sp.Basic) -> str:
    """The expression as text, by its numbered parts where they are many."""
    if length(e) < _WRITTEN:
        return str(e)
    number = dict[sp.Basic, str]()
    for part in subexpressions(e):
        number[part] = f"#{len(number)}"
    return " ".join(f"{type(p).__name__}({', '.join(number[a] for a in p.args) or p})" for p in number)


def with_shared_parts(e: sp.Expr) -> sp.Expr:
    """The expression, each part of it the same object as an equal part of those before.

    sympy compares objects that are equal part by part, as often as each is written out; its own memory of the last 1,000 results
    does so when an expression of shared parts is made a second time. Objects that are the same are not compared.
    """
    with _LOCK:
        if len(_KNOWN) > _MOST:
            forget()
        own = dict[int, sp.Basic]()
        left: list[tuple[sp.Basic, bool]] = [(e, False)]
        while left:
            part, whole = left.pop()
            if id(part) in _OWN or id(part) in own:
                continue
            if not whole:
                left += [(part, True), *((a, False) for a in part.args)]
                continue
            args = [own.get(id(a), a) for a in part.args]
            key = (part.func, *map(id, args)) if args else (part.func, part)
            if (same := _KNOWN.get(key)) is None:
                same = part
                if any(a is not b for a, b in zip(args, part.args, strict=True)):
                    made = part.func(*args)
                    alike = made.func == part.func and len(made.args) == len(args) and all(map(is_, made.args, args))
                    same = made if alike else part
                _KNOWN[key] = same
                _OWN.add(id(same))
            own[id(part)] = same
        return own.get(id(e), e)


def forget() -> None:
    """Let go of the parts that are known, and of what sympy remembers of them."""
    with _LOCK:
        _KNOWN.clear()
        _OWN.clear()
        clear_cache()
