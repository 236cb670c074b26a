"""Systems whose motions are proved in several files of tests, and changes of their certificates."""

import copy
import json
from typing import Any

import sympy as sp

from lagrotor.mechanics import System, coordinates

C = coordinates("theta")
(THETA,), (RATE,) = C.q, C.v
PENDULUM = System(C, RATE**2 / 2 + sp.cos(THETA))
PLANE = coordinates("x y")
(X, Y), (U, V) = PLANE.q, PLANE.v
HENON_HEILES = System(PLANE, (U**2 + V**2 - X**2 - Y**2) / 2 - X**2 * Y + Y**3 / 3)


def plain(theorem: Any) -> Any:
    """Return a theorem's certificate as it is read from a file."""
    return json.loads(json.dumps(theorem.certificate))


def verified(theorem: Any) -> str:
    """Return the theorem in the words of the second program, which reads the certificate from JSON."""
    from lagrotor.proofs import check

    return check(plain(theorem))


def moved(number: list[str], by: str) -> list[str]:
    """Return a ball [midpoint, radius] with its midpoint moved."""
    from flint import arb

    from lagrotor.proofs.balls import as_text, of_text, precision

    with precision(300):
        return [as_text((of_text(number[0]) + arb(by)).mid()), number[1]]


def spoiled(certificate: Any, path: str, value: Any) -> Any:
    """Return the certificate with another entry at a path a/0/b: a value, or a function of the old one."""
    other = copy.deepcopy(certificate)
    *way, last = path.split("/")
    at: Any = other
    for key in way:
        at = at[int(key) if isinstance(at, list) else key]
    place: Any = int(last) if isinstance(at, list) else last
    at[place] = value(at[place]) if callable(value) else value
    return other
