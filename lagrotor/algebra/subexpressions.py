"""The parts of an expression, each once: a Lagrangian of 24 rods has 2,000 different parts, and 6×10⁸ where it is written out."""

import sympy as sp

_WRITTEN = 100_000  # parts of an expression up to which it is written out


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
