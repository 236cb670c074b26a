"""Detection of two different symbols with one name: they print alike, but relations for one do not apply to the other."""

from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp

from lagrotor.errors import InputError


def check_names(where: str, *values: Any) -> None:
    """Raise InputError, whose text begins with `where`, if different symbols in the values share a name (except dummies)."""
    symbols = {symbol for symbol in symbols_in(values) if type(symbol) is sp.Symbol}
    if len(symbols) == len({symbol.name for symbol in symbols}):
        return
    first_of_name: dict[str, sp.Symbol] = {}
    for symbol in sorted(symbols, key=lambda s: (s.name, s.sort_key())):
        if (namesake := first_of_name.setdefault(symbol.name, symbol)) != symbol:
            kinds = " and ".join(sorted({_kind(symbol), _kind(namesake)}))
            raise InputError(
                f"{where}: two different symbols are called {symbol.name!r}, one declared {kinds.replace(' and ', ', one ')}: "
                "declare the symbol once and use it everywhere"
            )


def symbols_in(value: Any) -> Iterable[sp.Symbol]:
    """Yield the symbols of expressions, relations, rows and mappings of them, in no order, also repeatedly."""
    if isinstance(value, sp.Basic | sp.MatrixBase):
        yield from value.free_symbols
    elif isinstance(value, Mapping):
        for pair in value.items():
            yield from symbols_in(pair)
    elif isinstance(value, list | tuple | set | frozenset):
        for entry in value:
            yield from symbols_in(entry)


def _kind(symbol: sp.Symbol) -> str:
    """Return the assumptions of a symbol in words."""
    assumptions = {name: value for name, value in symbol.assumptions0.items() if name != "commutative" or not value}
    for name in ("positive", "negative", "nonnegative", "nonpositive", "integer", "real", "imaginary"):
        if assumptions.get(name):
            return name
    return ", ".join(sorted(assumptions)) or "without assumptions"
