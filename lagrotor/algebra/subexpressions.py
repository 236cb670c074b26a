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


def subexpressions(*expressions: sp.Basic) -> list[sp.Basic]:
    """Every different part of expressions, after those that it is made of."""
    ordered = dict[sp.Basic, None]()
    stack = [(e, False) for e in reversed(expressions)]
    while stack:
        node, whole = stack.pop()
        if whole:
            ordered[node] = None
        elif node not in ordered:
            stack += [(node, True), *((a, False) for a in reversed(node.args))]
    return list(ordered)


def free_letters(e: sp.Basic) -> set[sp.Symbol]:
    """Its free symbols."""
    inside = dict[sp.Basic, set[sp.Symbol]]()
    for node in subexpressions(e):
        bound = getattr(node, "bound_symbols", ())
        inside[node] = node.free_symbols if node.is_Atom or bound else set().union(*(inside[a] for a in node.args))
    return inside[e]


def length(e: sp.Basic) -> int:
    """How many parts it has where all are written out."""
    counts = dict[sp.Basic, int]()
    for node in subexpressions(e):
        counts[node] = 1 + sum(counts[a] for a in node.args)
    return counts[e]


def written(e: sp.Basic) -> str:
    """The expression as text, by its numbered parts where they are many."""
    if length(e) < _WRITTEN:
        return str(e)
    number = dict[sp.Basic, str]()
    for node in subexpressions(e):
        number[node] = f"#{len(number)}"
    return " ".join(f"{type(p).__name__}({', '.join(number[a] for a in p.args) or p})" for p in number)


def with_shared_parts(e: sp.Expr) -> sp.Expr:
    """The expression, each part of it the same object as an equal part of those before.

    sympy compares objects that are equal part by part, as often as each is written out; its own memory of the last 1,000 results
    does so when an expression of shared parts is made a second time. Objects that are the same are not compared.
    """
    with _LOCK:
        if len(_KNOWN) > _MOST:
            forget()
        shared = dict[int, sp.Basic]()
        stack: list[tuple[sp.Basic, bool]] = [(e, False)]
        while stack:
            node, whole = stack.pop()
            if id(node) in _OWN or id(node) in shared:
                continue
            if not whole:
                stack += [(node, True), *((a, False) for a in node.args)]
                continue
            args = [shared.get(id(a), a) for a in node.args]
            key = (node.func, *map(id, args)) if args else (node.func, node)
            if (same := _KNOWN.get(key)) is None:
                same = node
                if any(a is not b for a, b in zip(args, node.args, strict=True)):
                    rebuilt = node.func(*args)
                    alike = (
                        rebuilt.func == node.func
                        and len(rebuilt.args) == len(args)
                        and all(map(is_, rebuilt.args, args))
                    )
                    same = rebuilt if alike else node
                _KNOWN[key] = same
                _OWN.add(id(same))
            shared[id(node)] = same
        return shared.get(id(e), e)


def forget() -> None:
    """Let go of the parts that are known, and of what sympy remembers of them."""
    with _LOCK:
        _KNOWN.clear()
        _OWN.clear()
        clear_cache()
