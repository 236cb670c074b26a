"""The exceptions of the package. Each message names the place, the value, the reason and the remedy."""

from collections.abc import Iterable


class LagrotorError(Exception):
    """The base class of the errors that this package raises on purpose."""


class InputError(LagrotorError, ValueError):
    """An input without meaning, refused before work starts."""


class NotExactError(LagrotorError, ValueError):
    """An expression outside the class that is decided exactly."""


class TooLargeError(NotExactError):
    """An expression whose exact decision would take more work than allowed."""


class WorkError(LagrotorError):
    """A decision that needs more work than its caller allows. It is not recorded as undecided."""


class DomainError(LagrotorError, ValueError):
    """A closed form evaluated outside its domain."""


class ConstraintError(LagrotorError, ValueError):
    """A state that does not satisfy its holonomic constraints, or cannot be brought onto them."""


class NotASymmetryError(LagrotorError, ValueError):
    """A vector field that does not leave the Lagrangian invariant."""


class ProofError(LagrotorError, AssertionError):
    """A step of a derivation that does not hold, or that cannot be decided."""


class ScriptError(LagrotorError):
    """A script of a paper that fails: the message names its file and line."""


class SingularError(LagrotorError, ArithmeticError):
    """Coordinates or constraints that are singular at this state."""


class IntegrationError(LagrotorError, ArithmeticError):
    """An integration that could not reach the end of the run, or gave another motion, after so many evaluations."""

    evaluations: int = 0


class NotProved(LagrotorError):  # noqa: N818
    """A theorem that could not be proved, which may still be true. The message says how far the proof came."""


class LagrotorWarning(UserWarning):
    """A result whose error may exceed the tolerance. The message says by how much."""


def near(name: object, names: Iterable[str]) -> str:
    """Return the names that are near a wrong one as a question for the end of a message; "" if none is near."""
    from difflib import get_close_matches

    by_lower = {candidate.lower(): candidate for candidate in names}
    matches = get_close_matches(str(name).lower(), by_lower, 2, 0.7)
    return f": {' or '.join(map(by_lower.__getitem__, matches))}?" if matches else ""
