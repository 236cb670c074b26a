"""Theorems about motion that decide a part of a claim, or a number that is printed: their words, enclosure and certificate.

`lagrotor.proved` finds them and its `check` verifies them; it needs python-flint. Without it what is on record stands, and it
is said that it was not proved again.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import sympy as sp

from lagrotor.errors import InputError, NotProved, ProofError

NOT_AGAIN = "on record, not proved again here; `lagrotor claims` does, with python-flint: pip install lagrotor[proof]"


@dataclass(frozen=True)
class Theorem:
    """What is proved: `says`, in the words of `lagrotor.proved.check`; `encloses`, the enclosure as it is printed.

    Attributes:
        certificate: what `check` verifies, plain data; None where the theorem is on record only.
        bounds: rational numbers between which the quantity lies that a printed number is compared with.
    """

    says: str
    encloses: str = ""
    certificate: Mapping[str, Any] | None = None
    bounds: tuple[sp.Rational, sp.Rational] | None = None

    @classmethod
    def of(cls, proved: Any, encloses: str = "", bounds: tuple[Any, Any] | None = None) -> "Theorem":
        """That of a proof of `lagrotor.proved`, which needs python-flint.

        Args:
            proved: an orbit, a crossing, an enclosure or an equilibrium.
            encloses: the quantity of which it is.
            bounds: the numbers it says, if others than the proof's.
        """
        from lagrotor.proved.statements import theorem_of

        ends = None if bounds is None else (sp.Rational(bounds[0]), sp.Rational(bounds[1]))
        return cls(theorem_of(proved.certificate), encloses, proved.certificate, ends)

    @property
    def text(self) -> str:
        """Words and enclosure, and whether it was proved again here."""
        return " ".join(filter(None, (self.says, self.encloses, f"({NOT_AGAIN})" if self.certificate is None else "")))


def can_prove() -> bool:
    """Whether python-flint is there."""
    return find_spec("flint") is not None


def verify(theorems: Iterable[Theorem], where: str) -> None:
    """Check the certificate of each theorem, as it would be read from a file.

    Raises ProofError where a theorem has none, where `lagrotor.proved.check` rejects it, or where it proves something else.
    """
    from lagrotor.proved.verification.checking import check

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
