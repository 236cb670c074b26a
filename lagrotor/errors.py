"""The exceptions of the package. Each message names the place, the value, the reason and the remedy."""

from collections.abc import Iterable


class LagrotorError(Exception):
    """Every error this package raises on purpose."""


class InputError(LagrotorError, ValueError):
    """A value that makes no sense: refused before work starts."""


class NotExactError(LagrotorError, ValueError):
    """An expression outside the class that is decided exactly."""


class TooLargeError(NotExactError):
    """An exact decision would take more work than it may."""


class WorkError(LagrotorError):
    """A decision that needs more work than its caller allows; it is not kept as undecided."""


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
    """An integration that could not reach the end of the run, or gave another motion. evaluations: those known to be spent."""

    evaluations: int = 0


class NotProved(LagrotorError):  # noqa: N818
    """A theorem that could not be proved, which does not make it false; the message says how far the proof came."""


class LagrotorWarning(UserWarning):
    """A result whose error may exceed the tolerance; the message says what it keeps."""


def near(name: object, names: Iterable[str]) -> str:
    """The end of a refusal of a name: those of `names` that are near it, as a question; nothing where none is."""
    from difflib import get_close_matches

    known = {each.lower(): each for each in names}
    matches = get_close_matches(str(name).lower(), known, 2, 0.7)
    return f": {' or '.join(known[each] for each in matches)}?" if matches else ""
