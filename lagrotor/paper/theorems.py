"""Theorems about motion that decide a part of a claim, or a number that is printed: their words, enclosure and certificate.

`lagrotor.proofs` finds them and its `check` verifies them; it needs python-flint. Without it what is on record stands, and it
is said that it was not proved again.
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
    """What is proved: `says`, in the words of `lagrotor.proofs.check`; `encloses`, the enclosure as it is printed.

    Attributes
    ----------
    certificate : dict[str, Any] or None, optional
        What `check` verifies, plain data; None where the theorem is on record only.
    quantity : str, default ''
        The name in the certificate of what a printed number is compared with: a state, an expression of which it is
        the mean, `time`, `period` or `frequency`.
    """

    says: str
    encloses: str = ""
    certificate: dict[str, Any] | None = None
    quantity: str = ""

    @classmethod
    def of(cls, proved: Any, encloses: str = "", quantity: str = "") -> "Theorem":
        """That of a proof of `lagrotor.proofs`, which needs python-flint.

        Parameters
        ----------
        proved
            An orbit, a crossing, an enclosure or an equilibrium.
        encloses : str, default ''
            Its enclosure as it is printed.
        quantity : str, default ''
            What a printed number is held against.

        Raises
        ------
        InputError
            Where the theorem has no such quantity.
        """
        from lagrotor.proofs.statements import quantities, theorem_of

        if quantity and quantity not in (known := quantities(proved.certificate)):
            raise InputError(f"Theorem: it says nothing of {quantity!r}, but of {', '.join(known) or 'no number'}")
        return cls(theorem_of(proved.certificate), encloses, proved.certificate, quantity)

    @property
    def bounds(self) -> tuple[sp.Rational, sp.Rational] | None:
        """Of the quantity, as the certificate claims them; None where it has none."""
        if self.certificate is None or not self.quantity:
            return None
        from lagrotor.proofs.statements import quantities

        found = quantities(self.certificate)[self.quantity]
        mantissa_exponents = (end.man_exp() for end in (found.lower(), found.upper()))
        low, high = (sp.Integer(int(m)) * sp.Rational(2) ** int(e) for m, e in mantissa_exponents)
        return low, high

    @property
    def text(self) -> str:
        """Words and enclosure, and whether it was proved again here."""
        return " ".join(filter(None, (self.says, self.encloses, f"({NOT_AGAIN})" if self.certificate is None else "")))


def can_prove() -> bool:
    """Whether python-flint is there."""
    return find_spec("flint") is not None


def verify(theorems: Iterable[Theorem], where: str) -> None:
    """Check the certificate of each theorem, as it would be read from a file.

    Raises ProofError where a theorem has none, where `lagrotor.proofs.check` rejects it, or where it proves something else.
    """
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
