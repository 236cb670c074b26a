"""Proved equilibria and their stability. Equilibria of a Routhian are the steady motions of the full system.

An equilibrium is unstable if one eigenvalue of the linear motion has a positive real part, and asymptotically stable if all
have negative ones (Lyapunov). In a conservative system it is stable if the energy is definite there (Lagrange, Dirichlet).
It is stable to first order if all eigenvalues are distinct and imaginary.
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
    format_ball,
    matrix_data,
    precision,
    upper,
)
from lagrotor.proofs.fields import Field, Values, system_field, values_at, with_rationals
from lagrotor.proofs.matrices import inside, krawczyk, middle_inverse, times
from lagrotor.proofs.orbits.crossings import words
from lagrotor.proofs.orbits.enclosure import accuracy_of, add_margin
from lagrotor.proofs.statements import VERSION, Certificate, Proved
from lagrotor.proofs.tape import Tape, select_outputs

Stability = Literal["stable", "asymptotically stable", "stable to first order", "unstable", "undecided"]
TOL = 1e-25
_NEWTON = 30


@dataclass(frozen=True, eq=False, repr=False)
class ProvedEquilibrium(Proved):
    """An equilibrium that exists and is unique in a box.

    Attributes
    ----------
    names : tuple[str, ...]
        The names of the coordinates.
    q : tuple[Ball, ...]
        The coordinates of the equilibrium.
    stability : str
        'stable', 'asymptotically stable', 'stable to first order', 'unstable', or 'undecided' without a proof.
    eigenvalues : tuple[tuple[Ball, Ball], ...]
        Real and imaginary part of each eigenvalue of the linear motion in 1/s; empty if they are not proved to be distinct.
    certificate : Certificate
        The plain data that `check` verifies.
    """

    names: tuple[str, ...]
    q: tuple[Ball, ...]
    stability: Stability
    eigenvalues: tuple[tuple[Ball, Ball], ...]
    certificate: Certificate

    def summary(self) -> dict[str, str]:
        """Return the coordinates and the stability.

        Returns
        -------
        dict[str, str]
            Name → text.
        """
        return {n: format_ball(x, 25) for n, x in zip(self.names, self.q, strict=True)} | {"stability": self.stability}


def equilibrium(system: Equations, values: Values | None = None, q0: Any = None, tol: float = TOL) -> ProvedEquilibrium:
    """Prove that an equilibrium exists near `q0`, and determine its stability.

    Parameters
    ----------
    system : System
        A system without constraints and without explicit time.
    values : Mapping, optional
        Parameter → number, or pair (lowest, highest) for an interval.
    q0 : sequence, optional
        Coordinates near the equilibrium.
    tol : float, default 1e-25
        Target accuracy; it sets the precision.

    Returns
    -------
    ProvedEquilibrium
        The enclosed coordinates and the stability.

    Raises
    ------
    InputError
        If an argument does not fit the system.
    NotProved
        If no equilibrium can be proved near `q0`.

    Examples
    --------
    >>> import sympy as sp
    >>> from lagrotor.mechanics import System, coordinates
    >>> c = coordinates("theta")
    >>> equilibrium(System(c, c.v[0] ** 2 / 2 + sp.cos(c.q[0])), q0=[3])
    ProvedEquilibrium
      theta      [3.141592653589793238462643 +/- 3.84e-25]
      stability  unstable
    """
    if not isinstance(system, Equations):
        raise InputError(f"equilibrium: {system!r} must be a System")
    if system.multipliers or depends_on_time(system):
        raise InputError("equilibrium: the system must have no constraints and no explicit time: take free coordinates")
    accuracy, system = accuracy_of(tol, "equilibrium"), with_rationals(system)
    n = len(system.c.q)
    with precision(accuracy.bits, accuracy.terms):
        field = system_field(system, values or {}, q0, [0] * n)
        tape, parameters = field.motion.tape, [field.values[s] for s in field.arguments[2 * n :]]
        forces = select_outputs(tape, range(n, 2 * n))
        middle, box, A = locate(forces, [exact(x) for x in field.start[:n]], parameters)
        q = [a + b for a, b in zip(middle, box, strict=True)]
        state = [*q, *[arb(0)] * n, *parameters]
        _, rows = values_at(tape, state, True)
        J = arb_mat([row[: 2 * n] for row in rows])
        energy = _energy_hessian(field, system)
        hessian = arb_mat(2 * n, 2 * n, values_at(energy, state))
        stability, eigenvalues = stability_of(system, J, hessian)
        names = tuple(map(str, system.c.q))
        certificate = {
            "version": VERSION,
            "bits": accuracy.bits,
            "kind": "equilibrium",
            "about": field.subject,
            "motion": tape.data() | {"parameters": balls_data(parameters)},
            "middle": exact_data(middle),
            "box": balls_data([add_margin(x) for x in box]),
            "A": matrix_data(A),
            "energy": words(system.energy)["of"],
            "claim": {"q": balls_data([add_margin(x) for x in q]), "stability": stability},
        }
        return ProvedEquilibrium(names, tuple(q), stability, eigenvalues, certificate)


def locate(forces: Tape, middle: Balls, parameters: Sequence[Ball]) -> tuple[Balls, Balls, Matrix]:
    """Find an equilibrium by Newton's method, and prove it by the Krawczyk test.

    Return the midpoint, the box w about it that contains the equilibrium, and the preconditioner A.
    """
    n = len(middle)
    still = [arb(0)] * n
    last_size = float("inf")
    for _ in range(_NEWTON):
        value, rows = values_at(forces, [*middle, *still, *parameters], True)
        A = middle_inverse(arb_mat([row[:n] for row in rows]))
        move = times(A, value)
        size = max(float(upper(x)) for x in move)
        if size > 0.5 * last_size or size == 0:
            break
        last_size = size
        middle = [exact(a - b) for a, b in zip(middle, move, strict=True)]
    for grow in (2, 16, 2**10, 2**20):
        sizes = [upper(x) + arb(2) ** -200 + abs(m) * arb(2) ** -60 for x, m in zip(move, middle, strict=True)]
        w = [arb(0, (grow * size).upper()) for size in sizes]
        box = [a + b for a, b in zip(middle, w, strict=True)]
        value = values_at(forces, [*middle, *still, *parameters])
        _, rows = values_at(forces, [*box, *still, *parameters], True)
        image = krawczyk(value, arb_mat([row[:n] for row in rows]), A, w)
        if inside(image, w):
            return middle, image, A
    raise NotProved(
        f"equilibrium: Newton's method comes within {size:.1g}, but Krawczyk's test proves no equilibrium there"
    )


def _energy_hessian(field: Field, system: Equations) -> Tape:
    """Return the second derivatives of the Jacobi integral in (q, v), row by row; symbols without a value are 1."""
    states = (*system.c.q, *system.c.v)
    unused = dict.fromkeys(system.energy.free_symbols - {*field.arguments}, 1)
    first = [sp.diff(system.energy.xreplace(unused), x) for x in states]
    return field.function([sp.diff(e, x) for e in first for x in states])


def definite(matrix: Matrix) -> bool:
    """Return True if every symmetric matrix in a matrix ball is positive definite: all leading minors are positive.

    Examples
    --------
    >>> definite(arb_mat([[2, 1], [1, 2]])), definite(arb_mat([[1, 2], [2, 1]]))
    (True, False)
    """
    n = matrix.nrows()
    return all(arb_mat([[matrix[i, j] for j in range(k)] for i in range(k)]).det() > 0 for k in range(1, n + 1))


def stability_of(system: Equations, J: Matrix, energy: Matrix) -> tuple[Stability, tuple[tuple[Ball, Ball], ...]]:
    """Return the stability that the energy or the linear motion proves, and the eigenvalues if they are distinct."""
    conservative = system.dissipation == 0 and not any(system.forces)
    try:
        eigenvalues = [(z.real, z.imag) for z in J.eig()]
    except ValueError:
        eigenvalues = []
    if conservative and definite(energy):
        return "stable", tuple(eigenvalues)
    if any(real > 0 for real, _ in eigenvalues):
        return "unstable", tuple(eigenvalues)
    if eigenvalues and all(real < 0 for real, _ in eigenvalues):
        return "asymptotically stable", tuple(eigenvalues)
    if eigenvalues and conservative and on_axis(eigenvalues):
        return "stable to first order", tuple(eigenvalues)
    return "undecided", tuple(eigenvalues)


def on_axis(eigenvalues: Sequence[tuple[Ball, Ball]]) -> bool:
    """Return True if all eigenvalues are imaginary and distinct: the mirror image of each lies in its own ball alone."""
    heights = [imaginary for _, imaginary in eigenvalues]
    apart = all(not x.overlaps(y) for i, x in enumerate(heights) for y in heights[:i])
    return apart and all(real.contains(0) for real, _ in eigenvalues)
