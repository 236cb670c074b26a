"""Analytical mechanics from a Lagrangian in plain symbols: equations of motion, constraints, symmetries."""

from lagrotor.mechanics.constraints import Constrained, acceleration_bias, constrained_accelerations, degrees_of_freedom, jacobian, project_position, project_velocity, schur, solve_constrained, velocity_residual
from lagrotor.mechanics.lagrangian import Coordinates, accelerations, bias, coordinates, energy, euler_lagrange, mass_matrix, momenta, total_derivative
from lagrotor.mechanics.symmetry import cyclic_coordinates, is_conserved, legendre, noether_integral, noether_rate, routhian, variation

__all__ = [
    "Constrained",
    "Coordinates",
    "acceleration_bias",
    "accelerations",
    "bias",
    "constrained_accelerations",
    "coordinates",
    "cyclic_coordinates",
    "degrees_of_freedom",
    "energy",
    "euler_lagrange",
    "is_conserved",
    "jacobian",
    "legendre",
    "mass_matrix",
    "momenta",
    "noether_integral",
    "noether_rate",
    "project_position",
    "project_velocity",
    "routhian",
    "schur",
    "solve_constrained",
    "total_derivative",
    "variation",
    "velocity_residual",
]
