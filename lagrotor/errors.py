"""The exceptions of the package. Each message names the place, the value, the reason and the remedy."""

from collections.abc import Iterable


class LagrotorError(Exception):
    """The base class of the errors that this package raises on purpose."""


class InputError(LagrotorError, ValueError):
    """An input that has no meaning. It is refused before any work starts."""


class NotExactError(LagrotorError, ValueError):
    """An expression outside the class for which equality can be decided exactly."""


class TooLargeError(NotExactError):
    """An expression whose exact decision would take more work than allowed."""


class WorkError(LagrotorError):
    """A decision that needs more work than its caller allows. The answer is not recorded as undecided: more work may decide."""


class DomainError(LagrotorError, ValueError):
    """A closed form evaluated outside its domain."""


class ConstraintError(LagrotorError, ValueError):
    """A state that does not satisfy the holonomic constraints of its system, or cannot be projected onto them."""


class NotASymmetryError(LagrotorError, ValueError):
    """A vector field that does not leave the Lagrangian invariant."""


class ProofError(LagrotorError, AssertionError):
    """A step of a derivation that does not hold, or that cannot be decided."""


class ScriptError(LagrotorError):
    """A script of a paper that fails: the message names its file and line."""


class SingularError(LagrotorError, ArithmeticError):
    """Coordinates or constraints that are singular at the given state."""


class IntegrationError(LagrotorError, ArithmeticError):
    """An integration that failed before the end of the run, or that followed another motion, with other conserved quantities.

    `evaluations` is the number of evaluations of the right-hand side before it was given up.
    """

    evaluations: int = 0


class NotProved(LagrotorError):  # noqa: N818
    """A theorem that could not be proved, which may still be true. The message says how far the proof came."""


class LagrotorWarning(UserWarning):
    """A result whose error may exceed the tolerance. The message says by how much."""


def near(name: object, names: Iterable[str]) -> str:
    """Return a question for the end of an error message, ": mass or mast?", with names like `name`; "" if none is like it."""
    from difflib import get_close_matches

    by_lower = {candidate.lower(): candidate for candidate in names}
    matches = get_close_matches(str(name).lower(), by_lower, 2, 0.7)
    return f": {' or '.join(map(by_lower.__getitem__, matches))}?" if matches else ""
