"""Equilibria proved, with their stability: of a system after Routh's reduction they are its steady motions.

By the eigenvalues of the linear motion it is unstable where one has a positive real part, asymptotically stable where all have
negative ones (Lyapunov). Of a conservative system it is stable where the energy is definite there (Lagrange and Dirichlet), and
stable to first order where all eigenvalues are apart and lie on the imaginary axis.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import sympy as sp

from lagrotor.errors import InputError, NotProved
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running.programs import depends_on_time
from lagrotor.proofs.balls import (
    Ball,
    Balls,
    Matrix,
    arb,
    arb_mat,
    balls_data,
    exact,
    exact_data,
    matrix_data,
    precision,
    printed,
    upper,
)
from lagrotor.proofs.fields import Field, Values, exactly_meant, system_field, values_at
from lagrotor.proofs.matrices import inside, krawczyk, middle_inverse, times
from lagrotor.proofs.orbits.crossings import words
from lagrotor.proofs.orbits.enclosure import accuracy_of, loosened
from lagrotor.proofs.statements import VERSION, Certificate, Proved
from lagrotor.proofs.tape import Tape, joined

Stability = Literal["stable", "asymptotically stable", "stable to first order", "unstable", "undecided"]
TOL = 1e-25
_NEWTON = 30


@dataclass(frozen=True, eq=False, repr=False)
class ProvedEquilibrium(Proved):
    """An equilibrium that exists, the only one in a box about it. q: its coordinates, balls; stability: what is proved of it.

    Attributes
    ----------
    eigenvalues : tuple[tuple[Ball, Ball], ...]
        Of the linear motion, balls (real, imaginary), where they are apart.
    certificate : Certificate
        What `check` verifies.
    """

    names: tuple[str, ...]
    q: tuple[Ball, ...]
    stability: Stability
    eigenvalues: tuple[tuple[Ball, Ball], ...]
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """Coordinates and stability, name → words."""
        return {n: printed(x, 25) for n, x in zip(self.names, self.q, strict=True)} | {"stability": self.stability}


def equilibrium(system: Equations, values: Values | None = None, q0: Any = None, tol: float = TOL) -> ProvedEquilibrium:
    """An equilibrium proved to exist, with its stability.

    Parameters
    ----------
    system : Equations
        A `System`.
    values : Values or None, optional
        Numbers or pairs (lowest, highest).
    q0 : optional
        Near which it lies.
    tol : float, default TOL
        As in `enclose`.

    Raises
    ------
    InputError
        For what makes no sense.
    NotProved
        Where none can be proved near q0.
    """
    if not isinstance(system, Equations):
        raise InputError(f"equilibrium: {system!r} must be a System")
    if system.multipliers or depends_on_time(system):
        raise InputError("equilibrium: the system must have no constraints and no time: take free coordinates")
    accuracy, system = accuracy_of(tol, "equilibrium"), exactly_meant(system)
    n = len(system.c.q)
    with precision(accuracy.bits, accuracy.terms):
        made = system_field(system, values or {}, q0, [0] * n)
        tape, parameters = made.motion.tape, [made.values[s] for s in made.arguments[2 * n :]]
        forces = joined(tape, range(n, 2 * n))
        middle, box, A = located(forces, [exact(x) for x in made.start[:n]], parameters)
        q = [a + b for a, b in zip(middle, box, strict=True)]
        state = [*q, *[arb(0)] * n, *parameters]
        _, rows = values_at(tape, state, True)
        J = arb_mat([row[: 2 * n] for row in rows])
        energy = _energy_hessian(made, system)
        found = arb_mat(2 * n, 2 * n, values_at(energy, state))
        stability, eigenvalues = stability_of(system, J, found)
        names = tuple(map(str, system.c.q))
        certificate = {
            "version": VERSION,
            "bits": accuracy.bits,
            "kind": "equilibrium",
            "about": made.about,
            "motion": tape.data() | {"parameters": balls_data(parameters)},
            "middle": exact_data(middle),
            "box": balls_data([loosened(x) for x in box]),
            "A": matrix_data(A),
            "energy": words(system.energy)["of"],
            "claim": {"q": balls_data([loosened(x) for x in q]), "stability": stability},
        }
        return ProvedEquilibrium(names, tuple(q), stability, eigenvalues, certificate)


def located(forces: Tape, middle: Balls, parameters: Sequence[Ball]) -> tuple[Balls, Balls, Matrix]:
    """Newton's method, then Krawczyk's test: the middle, the box about it that holds the equilibrium, and A."""
    n = len(middle)
    still = [arb(0)] * n
    before = float("inf")
    for _ in range(_NEWTON):
        value, rows = values_at(forces, [*middle, *still, *parameters], True)
        A = middle_inverse(arb_mat([row[:n] for row in rows]))
        move = times(A, value)
        size = max(float(upper(x)) for x in move)
        if size > 0.5 * before or size == 0:
            break
        before = size
        middle = [exact(a - b) for a, b in zip(middle, move, strict=True)]
    for grow in (2, 16, 2**10, 2**20):
        w = [
            arb(0, (grow * (upper(x) + arb(2) ** -200 + abs(m) * arb(2) ** -60)).upper())
            for x, m in zip(move, middle, strict=True)
        ]
        box = [a + b for a, b in zip(middle, w, strict=True)]
        value = values_at(forces, [*middle, *still, *parameters])
        _, rows = values_at(forces, [*box, *still, *parameters], True)
        found = krawczyk(value, arb_mat([row[:n] for row in rows]), A, w)
        if inside(found, w):
            return middle, found, A
    raise NotProved(f"equilibrium: Newton's method comes within {size:.1g}, but Krawczyk's test does not close there")


def _energy_hessian(made: Field, system: Equations) -> Tape:
    """The second derivatives of the Jacobi integral by (q, v), row by row, 1 for letters that are not in the equations."""
    states = (*system.c.q, *system.c.v)
    unused = dict.fromkeys(system.energy.free_symbols - {*made.arguments}, 1)
    first = [sp.diff(system.energy.xreplace(unused), x) for x in states]
    return made.function([sp.diff(e, x) for e in first for x in states])


def definite(matrix: Matrix) -> bool:
    """Whether every symmetric matrix of a ball is positive definite: all leading minors are positive."""
    n = matrix.nrows()
    return all(arb_mat([[matrix[i, j] for j in range(k)] for i in range(k)]).det() > 0 for k in range(1, n + 1))


def stability_of(system: Equations, J: Matrix, energy: Matrix) -> tuple[Stability, tuple[tuple[Ball, Ball], ...]]:
    """Return the stability that the energy or the linear motion proves, and the eigenvalues where they are apart."""
    conservative = system.dissipation == 0 and not any(system.forces)
    try:
        found = [(z.real, z.imag) for z in J.eig()]
    except ValueError:
        found = []
    if conservative and definite(energy):
        return "stable", tuple(found)
    if any(real > 0 for real, _ in found):
        return "unstable", tuple(found)
    if found and all(real < 0 for real, _ in found):
        return "asymptotically stable", tuple(found)
    if found and conservative and on_axis(found):
        return "stable to first order", tuple(found)
    return "undecided", tuple(found)


def on_axis(found: Sequence[tuple[Ball, Ball]]) -> bool:
    """Whether all eigenvalues are shown to be imaginary and apart: the spectrum of a conservative system is its own mirror image
    in the imaginary axis, and no ball but its own holds the image of an eigenvalue.
    """
    heights = [imaginary for _, imaginary in found]
    apart = all(not x.overlaps(y) for i, x in enumerate(heights) for y in heights[:i])
    return apart and all(real.contains(0) for real, _ in found)
