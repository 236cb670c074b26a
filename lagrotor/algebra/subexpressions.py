"""The distinct subexpressions of an expression: a Lagrangian of 24 rods has 2,000 of them in a tree of 6×10⁸ nodes."""

from operator import is_
from threading import RLock
from typing import Any

import sympy as sp
from sympy.core.cache import clear_cache

_WRITTEN = 100_000  # nodes of the largest tree that is written as such
_MOST = 200_000  # objects in the table

# Shared objects by class and identities of the arguments (by value for a leaf); their identities.
_KNOWN = dict[Any, sp.Basic]()
_OWN = set[int]()
_LOCK = RLock()


def subexpressions(*expressions: sp.Basic) -> list[sp.Basic]:
    """Return the distinct subexpressions, each after its arguments."""
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
    inside = dict[sp.Basic, set[sp.Symbol]]()
    for node in subexpressions(e):
        bound = getattr(node, "bound_symbols", ())
        inside[node] = node.free_symbols if node.is_Atom or bound else set().union(*(inside[a] for a in node.args))
    return inside[e]


def length(e: sp.Basic) -> int:
    """Return the number of nodes of the expression's tree."""
    counts = dict[sp.Basic, int]()
    for node in subexpressions(e):
        counts[node] = 1 + sum(counts[a] for a in node.args)
    return counts[e]


def written(e: sp.Basic) -> str:
    """Return the expression as text. A large expression is written as a list of numbered subexpressions."""
    if length(e) < _WRITTEN:
        return str(e)
    number = dict[sp.Basic, str]()
    for node in subexpressions(e):
        number[node] = f"#{len(number)}"
    return " ".join(f"{type(p).__name__}({', '.join(number[a] for a in p.args) or p})" for p in number)


def with_shared_parts(e: sp.Expr) -> sp.Expr:
    """Return the expression with each subexpression replaced by an equal earlier object.

    sympy compares equal but distinct objects node by node, as often as the tree repeats them, but not identical ones.
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
                    new = node.func(*args)
                    alike = new.func == node.func and len(new.args) == len(args) and all(map(is_, new.args, args))
                    same = new if alike else node
                _KNOWN[key] = same
                _OWN.add(id(same))
            shared[id(node)] = same
        return shared.get(id(e), e)


def forget() -> None:
    """Clear the table of shared objects and sympy's cache."""
    with _LOCK:
        _KNOWN.clear()
        _OWN.clear()
        clear_cache()
