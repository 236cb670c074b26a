"""The printed form of results: numbers in powers of ten, formulas, and a `summary` in lines or as a table."""

from collections.abc import Callable, Iterable, Mapping
from html import escape
from math import isfinite
from numbers import Complex, Integral, Real
from typing import Any, ClassVar

_HIGH = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_MOST = 8  # rows and columns of an array that is written out
_ROUNDING = (
    1e-12  # a part of a complex number, or a component, that is smaller than the rest by this factor is rounding
)


def superscript(power: int) -> str:
    """Return an integer exponent in superscript digits: −14 as ⁻¹⁴."""
    return str(power).translate(_HIGH)


def scientific(value: float, digits: int = 0) -> str:
    """Return a number in powers of ten: 3e-14 as 3×10⁻¹⁴, 2 as 2.

    Parameters
    ----------
    value : float
        The number.
    digits : int, default 0
        The number of digits after the point.

    Returns
    -------
    str
        The printed number.
    """
    if value == 0:
        return "0"
    mantissa, _, power = f"{value:.{digits}e}".partition("e")
    return mantissa.replace("-", "−") + (f"×10{superscript(int(power))}" if int(power) else "")


def text_of(value: Any) -> str:
    """Return a value as it is written by hand: numbers with six digits, formulas, vectors, and the rows of small matrices."""
    if value is None or isinstance(value, bool):
        return {None: "none", True: "yes", False: "no"}[value]
    if isinstance(value, str):
        return value
    if isinstance(value, Real) and not hasattr(value, "free_symbols"):
        if isinstance(value, Integral) or not isfinite(value):
            return f"{value:,}".replace("-", "−").replace("inf", "∞")
        mantissa, _, power = f"{value:.6g}".replace("-", "−", int(value < 0)).partition("e")
        return mantissa + (f"×10{superscript(int(power))}" if power else "")
    if _is_rounded(value):
        return _complex(complex(value), abs(complex(value)))
    if isinstance(value, Mapping):
        return ", ".join(f"{text_of(name)} = {text_of(each)}" for name, each in value.items())
    if hasattr(value, "shape") and hasattr(value, "tolist"):
        return _array(value)
    if hasattr(value, "free_symbols"):
        from lagrotor.formula_text import formula

        return formula(value, text_of)
    return ", ".join(map(text_of, value)) if isinstance(value, Iterable) else str(value)


def _is_rounded(value: Any) -> bool:
    """Return True for a number of Python or numpy, and for an expression of sympy without symbols that contains a Float."""
    if hasattr(value, "free_symbols"):
        return bool(getattr(value, "is_number", False)) and any(x.is_Float for x in value.atoms())
    return isinstance(value, Complex)


def _complex(value: complex, size: float) -> str:
    """Return a complex number without parts that are rounding of numbers of this size."""
    real, imaginary = (x if abs(x) > _ROUNDING * size else 0.0 for x in (value.real, value.imag))
    if not imaginary:
        return text_of(real)
    sign = "−" if imaginary < 0 else "+" * bool(real)
    return (f"{text_of(real)} {sign} " if real else sign) + f"{text_of(abs(imaginary))} i"


def _array(value: Any) -> str:
    """Return a vector in brackets, the rows of a small matrix, or the shape of a larger array."""
    rows = value.tolist()
    if not value.shape:
        return text_of(rows)
    if len(value.shape) > 2 or max(value.shape) > _MOST:
        return f"an array of shape {tuple(value.shape)}"
    flat = [each for row in rows for each in row] if len(value.shape) == 2 else rows
    rounded = any(map(_is_rounded, flat)) and not any(getattr(x, "free_symbols", ()) for x in flat)
    size = max((abs(complex(x)) for x in flat), default=0.0) if rounded else 0.0
    written = [_complex(complex(x), size) if rounded else text_of(x) for x in flat]
    if len(value.shape) == 1 or 1 in value.shape:
        return f"({', '.join(written)})"
    columns = value.shape[1]
    widths = [max(map(len, written[j::columns])) for j in range(columns)]
    lines = (written[i : i + columns] for i in range(0, len(written), columns))
    return "\n".join(f"[{'  '.join(f'{x:>{w}}' for x, w in zip(line, widths, strict=True))}]" for line in lines)


def in_lines(title: str, rows: Mapping[str, str]) -> str:
    """Return a title and the lines of each row {name: text}."""
    width = max(map(len, rows), default=0)
    indent = "\n" + " " * (width + 4)
    return "\n".join([title, *(f"  {name:{width}}  {says.replace(chr(10), indent)}" for name, says in rows.items())])


class Shown:
    """A result that is printed in lines, and in Jupyter as a table. A dataclass that inherits it needs repr=False.

    `_shown` gives `summary` its rows: pairs of a name with its unit, and an attribute or a function of the result.
    """

    _shown: ClassVar[tuple[tuple[str, str | Callable[[Any], Any]], ...]] = ()

    def summary(self) -> dict[str, str]:
        """Return the result in words.

        Returns
        -------
        dict of str
            {name of a quantity, with its unit: its value as text}.
        """
        values = {name: getattr(self, of) if isinstance(of, str) else of(self) for name, of in self._shown}
        return {name: text_of(value) for name, value in values.items() if value is not None and not _is_empty(value)}

    def __repr__(self) -> str:
        return in_lines(type(self).__name__, self.summary())

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{f'<pre>{escape(says)}</pre>' if chr(10) in says else escape(says)}</td></tr>"
            for name, says in self.summary().items()
        )
        return f"<table><caption>{escape(type(self).__name__)}</caption>{rows}</table>"


class Printed(Shown):
    """A dataclass that is printed in lines and keeps the repr of a dataclass, as an argument that one types."""

    def __str__(self) -> str:
        return in_lines(type(self).__name__, self.summary())


class ShownInOneLine(Printed):
    """The base of results that come in tuples. The `repr` of each is one line, so that the tuple can be read."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name} = {says}' for name, says in self.summary().items())})"


def _is_empty(value: Any) -> bool:
    return (isinstance(value, tuple | Mapping | str) and not value) or 0 in getattr(value, "shape", ())
