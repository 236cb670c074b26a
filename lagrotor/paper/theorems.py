"""Theorems about motions. A theorem decides a part of a claim or a printed number.

`lagrotor.proofs` proves the theorems, and its `check` verifies their certificates; both need python-flint. Without python-flint
the theorems on record are used, and the report says that they were not proved again.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotProved, ProofError

NOT_AGAIN = "on record, not proved again here; lagrotor claims does, with python-flint: pip install lagrotor[proof]"


@dataclass(frozen=True, repr=False)
class Theorem:
    """A theorem about a motion, with the certificate from which it can be verified.

    Attributes
    ----------
    says : str
        The theorem, worded as `lagrotor.proofs.check` returns it.
    encloses : str, default ''
        A sentence on the numbers that the theorem encloses.
    certificate : dict[str, Any] or None, optional
        Plain data that `check` verifies; None for a theorem that is only on record.
    quantity : str, default ''
        The quantity that a printed number is compared with, by its name in the certificate. It is a state, an expression
        whose mean is enclosed, `time`, `period` or `frequency`.

    Examples
    --------
    >>> Theorem("The orbit is periodic.", "period = [0.785, 0.786] s").text
    'The orbit is periodic. period = [0.785, 0.786] s (on record, not proved again here; ...
    """

    says: str
    encloses: str = ""
    certificate: dict[str, Any] | None = None
    quantity: str = ""

    @classmethod
    def of(cls, proved: Any, encloses: str = "", quantity: str = "") -> "Theorem":
        """Make a theorem from a proof of `lagrotor.proofs`, which needs python-flint.

        Parameters
        ----------
        proved : Any
            A proved orbit, crossing, enclosure or equilibrium.
        encloses : str, default ''
            A sentence on the numbers that the theorem encloses.
        quantity : str, default ''
            Name of the quantity that a printed number is compared with.

        Returns
        -------
        Theorem
            The theorem with the proof's certificate.

        Raises
        ------
        InputError
            If the theorem has no such quantity.
        """
        from lagrotor.proofs.statements import quantities, theorem_of

        if quantity and quantity not in (names := quantities(proved.certificate)):
            raise InputError(f"Theorem: it has no quantity {quantity!r}; it has {', '.join(names) or 'no quantity'}")
        return cls(theorem_of(proved.certificate), encloses, proved.certificate, quantity)

    @property
    def bounds(self) -> tuple[sp.Rational, sp.Rational] | None:
        """The lower and the upper bound of the `quantity`, from the certificate; None if no quantity is named."""
        if self.certificate is None or not self.quantity:
            return None
        from lagrotor.proofs.statements import quantities

        ball = quantities(self.certificate)[self.quantity]
        mantissa_exponents = (end.man_exp() for end in (ball.lower(), ball.upper()))
        low, high = (sp.Integer(int(m)) * sp.Rational(2) ** int(e) for m, e in mantissa_exponents)
        return low, high

    @property
    def text(self) -> str:
        """The theorem in words and its enclosure. For a theorem on record, a note says that it was not proved again."""
        return " ".join(filter(None, (self.says, self.encloses, f"({NOT_AGAIN})" if self.certificate is None else "")))

    def __repr__(self) -> str:
        return f"Theorem: {self.text}"


def can_prove() -> bool:
    """Return True if python-flint is installed."""
    return find_spec("flint") is not None


def verify(theorems: Iterable[Theorem], where: str) -> None:
    """Check the certificate of each theorem after a round trip through JSON. Raise ProofError if one is missing or rejected."""
    from lagrotor.proofs.checker.checking import check

    for theorem in theorems:
        if theorem.certificate is None:
            raise ProofError(f"{where}: a theorem has no certificate: {theorem.says}")
        try:
            verified = check(json.loads(json.dumps(theorem.certificate)))
        except (InputError, NotProved, TypeError) as refusal:
            raise ProofError(f"{where}: the certificate of a theorem is rejected: {refusal}") from None
        if verified != theorem.says:
            raise ProofError(
                f"{where}: the certificate proves another theorem: {verified} The claimed theorem is: {theorem.says}"
            )
