"""Two different symbols of one name print alike and are not equal: what holds of one says nothing of the other."""

from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp

from lagrotor.errors import InputError


def check_names(where: str, *given: Any) -> None:
    """Refuse symbols of one name and other assumptions.

    Parameters
    ----------
    where : str
        How the error begins.
    given
        Expressions, matrices, relations, rows and mappings of them; anything else is passed over, and so are dummies.

    Raises
    ------
    InputError
        If there are two.
    """
    seen: dict[str, sp.Symbol] = {}
    for symbol in symbols_in(given):
        if type(symbol) is sp.Symbol and (other := seen.setdefault(symbol.name, symbol)) != symbol:
            kinds = " and ".join(sorted({_kind(symbol), _kind(other)}))
            raise InputError(
                f"{where}: two different symbols are called {symbol.name!r}, one declared {kinds.replace(' and ', ', one ')}: "
                "declare the letter once and use it everywhere"
            )


def symbols_in(given: Any) -> Iterable[sp.Symbol]:
    """Yield the symbols of expressions, relations, rows and mappings of them, each as often as it occurs."""
    if isinstance(given, sp.Basic | sp.MatrixBase):
        yield from sorted(given.free_symbols, key=lambda s: (str(s), s.sort_key()))
    elif isinstance(given, Mapping):
        for pair in given.items():
            yield from symbols_in(pair)
    elif isinstance(given, list | tuple | set | frozenset):
        for each in given:
            yield from symbols_in(each)


def _kind(symbol: sp.Symbol) -> str:
    """What a symbol was declared with, in words."""
    said = {name: value for name, value in symbol.assumptions0.items() if name != "commutative" or not value}
    for name in ("positive", "negative", "nonnegative", "nonpositive", "integer", "real", "imaginary"):
        if said.get(name):
            return name
    return ", ".join(sorted(said)) or "without assumptions"
