"""Analytical mechanics in plain symbols: any Lagrangian system, its equations, symmetries and small motions."""

from lagrotor.mechanics.bodies.frames import Frame
from lagrotor.mechanics.constraints import project_position, project_velocity, solve_constrained
from lagrotor.mechanics.equations import constrained_accelerations, degrees_of_freedom
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.lagrangian import (
    Coordinates,
    accelerations,
    bias,
    coordinates,
    energy,
    euler_lagrange,
    mass_matrix,
    momenta,
    t,
    total_derivative,
)
from lagrotor.mechanics.linear_modes import LinearSystem, Mode
from lagrotor.mechanics.symmetry import FirstIntegral, legendre
from lagrotor.mechanics.systems import System

__all__ = [
    "Coordinates",
    "Equilibrium",
    "FirstIntegral",
    "Frame",
    "LinearSystem",
    "Mode",
    "System",
    "accelerations",
    "bias",
    "constrained_accelerations",
    "coordinates",
    "degrees_of_freedom",
    "energy",
    "euler_lagrange",
    "legendre",
    "mass_matrix",
    "momenta",
    "project_position",
    "project_velocity",
    "solve_constrained",
    "t",
    "total_derivative",
]
