"""Theorems about motions, which decide a part of a claim or a printed number.

`lagrotor.proofs` proves them and its `check` verifies their certificates; both need python-flint. Without python-flint the
theorems on record are used, and the report says that they were not proved again.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotProved, ProofError

NOT_AGAIN = "on record, not proved again here; lagrotor claims does, with python-flint: pip install lagrotor[proof]"


@dataclass(frozen=True)
class Theorem:
    """A theorem about a motion, with the certificate from which it can be verified.

    Attributes
    ----------
    says : str
        The theorem in the words of `lagrotor.proofs.check`.
    encloses : str, default ''
        The enclosure of its numbers, in words.
    certificate : dict[str, Any] or None, optional
        Plain data that `check` verifies; None for a theorem that is only on record.
    quantity : str, default ''
        Name in the certificate of the quantity that a printed number is compared with: a state, an expression whose
        mean is enclosed, `time`, `period` or `frequency`.

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
        """Return the theorem of a proof from `lagrotor.proofs`, which needs python-flint.

        Parameters
        ----------
        proved : Any
            An orbit, a crossing, an enclosure or an equilibrium.
        encloses : str, default ''
            Its enclosure in words.
        quantity : str, default ''
            Name of the quantity that a printed number is compared with.

        Returns
        -------
        Theorem
            With the proof's certificate.

        Raises
        ------
        InputError
            If the theorem has no such quantity.
        """
        from lagrotor.proofs.statements import quantities, theorem_of

        if quantity and quantity not in (names := quantities(proved.certificate)):
            raise InputError(f"Theorem: it has no quantity {quantity!r}; it has {', '.join(names) or 'none'}")
        return cls(theorem_of(proved.certificate), encloses, proved.certificate, quantity)

    @property
    def bounds(self) -> tuple[sp.Rational, sp.Rational] | None:
        """The lower and the upper bound of the quantity in the certificate; None without a quantity."""
        if self.certificate is None or not self.quantity:
            return None
        from lagrotor.proofs.statements import quantities

        ball = quantities(self.certificate)[self.quantity]
        mantissa_exponents = (end.man_exp() for end in (ball.lower(), ball.upper()))
        low, high = (sp.Integer(int(m)) * sp.Rational(2) ** int(e) for m, e in mantissa_exponents)
        return low, high

    @property
    def text(self) -> str:
        """The words and the enclosure; of a theorem on record, with a note that it was not proved again."""
        return " ".join(filter(None, (self.says, self.encloses, f"({NOT_AGAIN})" if self.certificate is None else "")))


def can_prove() -> bool:
    """Return True if python-flint is installed."""
    return find_spec("flint") is not None


def verify(theorems: Iterable[Theorem], where: str) -> None:
    """Check each theorem's certificate after a round trip through JSON; raise ProofError if it is missing or rejected."""
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
                f"{where}: the certificate proves something else: {verified} It is said to be: {theorem.says}"
            )
