"""The printed form of results: numbers in powers of ten, and a `summary` in lines or as a table."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from html import escape

_HIGH = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


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


def in_lines(title: str, rows: Mapping[str, str]) -> str:
    """Return a title and one line for each row {name: text}."""
    width = max(map(len, rows), default=0)
    return "\n".join([title, *(f"  {name:{width}}  {says}" for name, says in rows.items())])


class Shown(ABC):
    """A result whose `summary` is printed as lines, and in Jupyter as a table. A dataclass that inherits it needs repr=False."""

    @abstractmethod
    def summary(self) -> dict[str, str]:
        """Return the result in words: {name of a quantity: its value as text}."""

    def __repr__(self) -> str:
        return in_lines(type(self).__name__, self.summary())

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(says)}</td></tr>" for name, says in self.summary().items()
        )
        return f"<table><caption>{escape(type(self).__name__)}</caption>{rows}</table>"
