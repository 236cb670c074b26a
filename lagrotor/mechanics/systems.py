"""A mechanical system, and what can be asked of it."""

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from lagrotor.mechanics import equilibria, linear_modes, sameness, symmetry
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.running import integration, simulation


@dataclass(frozen=True)
class System(Equations):
    """System(c, L, constraints=(), rolling=(), dissipation=0, forces=()): a Lagrangian L(q, v, t), and what acts on it.

        c = coordinates("theta")
        pendulum = System(c, m * l**2 * c.v[0]**2 / 2 + m * g * l * cos(c.q[0]), dissipation=k * c.v[0]**2 / 2)

    The arguments are those of `Equations`, which this class adds its questions to.
    """

    @cached_property
    def cyclic(self) -> tuple[sp.Symbol, ...]:
        """The coordinates with a conserved momentum."""
        return symmetry.cyclic_coordinates(self)

    variation = symmetry.variation
    invariance = symmetry.invariance
    noether = symmetry.noether
    noether_rate = symmetry.noether_rate
    conserved = symmetry.conserved
    routh = symmetry.routh
    equilibria = equilibria.equilibria
    linearise = linear_modes.linearise
    same_as = sameness.same_as
    in_coordinates = sameness.in_coordinates
    consistent = integration.consistent
    simulate = simulation.simulate
