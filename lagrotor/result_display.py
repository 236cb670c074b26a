"""The printed form of results: numbers in powers of ten, and a `summary` in lines or as a table."""

from abc import ABC, abstractmethod
from html import escape

_HIGH = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def superscript(power: int) -> str:
    """Return a whole power in superscript: −14 as ⁻¹⁴."""
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


class Shown(ABC):
    """A result with a `summary`, printed in lines and in Jupyter as a table. A dataclass of this kind has repr=False."""

    @abstractmethod
    def summary(self) -> dict[str, str]:
        """Return the result in words, by name."""

    def __repr__(self) -> str:
        rows = self.summary()
        width = max(map(len, rows))
        return "\n".join([type(self).__name__, *(f"  {name:{width}}  {says}" for name, says in rows.items())])

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(says)}</td></tr>" for name, says in self.summary().items()
        )
        return f"<table><caption>{escape(type(self).__name__)}</caption>{rows}</table>"
