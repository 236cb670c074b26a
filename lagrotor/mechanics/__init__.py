"""Analytical mechanics in plain symbols: Lagrangian systems, their equations, symmetries, small motions and simulations.

The main types, in the order in which data passes through them:

    Coordinates     q, v = q', a = q'' as independent symbols (`lagrangian`)
    Frame, Body     joints, bodies, contacts and force elements of a mechanism, which give energies and forces (`bodies`)
    System          L(q, v, t), constraints, rolling, dissipation and forces (`systems`, `equations`, `quasi_velocities`)
    FirstIntegral   Noether integrals, Routh's reduction, equality of systems (`symmetry`)
    Equilibrium     equilibria (`equilibria`), the LinearSystem there (`linear_modes`), steady motions (`steady_motions`)
    Oscillation     series of a periodic motion, AveragedMotion of a slow amplitude (`weakly_nonlinear`, by `fourier`)
    Hamiltonian     brackets, canonical transformations, NormalForm (`canonical`)
    SystemRun       a simulated motion with its error (`running`)

Equations are expressions; numpy and scipy are imported when a method needs numbers. `System` has every analysis as a method of
one line. To add an analysis, write a function of an `Equations` in a module of its own and a method of `System` that calls
it.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.mechanics.bodies.contacts import Contact as Contact
    from lagrotor.mechanics.bodies.contacts import Cylinder as Cylinder
    from lagrotor.mechanics.bodies.contacts import Plane as Plane
    from lagrotor.mechanics.bodies.contacts import Sphere as Sphere
    from lagrotor.mechanics.bodies.force_elements import Pathway as Pathway
    from lagrotor.mechanics.bodies.inertial_parameters import BaseParameters as BaseParameters
    from lagrotor.mechanics.bodies.joint_forces import JointForce as JointForce
    from lagrotor.mechanics.bodies.rigid_bodies import Frame as Frame
    from lagrotor.mechanics.canonical.hamiltonians import GeneratedTransformation as GeneratedTransformation
    from lagrotor.mechanics.canonical.hamiltonians import Hamiltonian as Hamiltonian
    from lagrotor.mechanics.canonical.normal_forms import NormalForm as NormalForm
    from lagrotor.mechanics.canonical.normal_forms import birkhoff as birkhoff
    from lagrotor.mechanics.canonical.return_maps import ReturnMapForm as ReturnMapForm
    from lagrotor.mechanics.equations import constrained_accelerations as constrained_accelerations
    from lagrotor.mechanics.equations import degrees_of_freedom as degrees_of_freedom
    from lagrotor.mechanics.equations import reaction as reaction
    from lagrotor.mechanics.equilibria import Equilibrium as Equilibrium
    from lagrotor.mechanics.lagrangian import Coordinates as Coordinates
    from lagrotor.mechanics.lagrangian import accelerations as accelerations
    from lagrotor.mechanics.lagrangian import coordinates as coordinates
    from lagrotor.mechanics.lagrangian import energy as energy
    from lagrotor.mechanics.lagrangian import euler_lagrange as euler_lagrange
    from lagrotor.mechanics.lagrangian import mass_matrix as mass_matrix
    from lagrotor.mechanics.lagrangian import momenta as momenta
    from lagrotor.mechanics.lagrangian import t as t
    from lagrotor.mechanics.lagrangian import total_derivative as total_derivative
    from lagrotor.mechanics.linear_modes import LinearSystem as LinearSystem
    from lagrotor.mechanics.linear_modes import Mode as Mode
    from lagrotor.mechanics.running.monodromy import MonodromyMatrix as MonodromyMatrix
    from lagrotor.mechanics.running.programs import motion_program as motion_program
    from lagrotor.mechanics.running.root_loci import RootLocus as RootLocus
    from lagrotor.mechanics.running.root_loci import StabilityChart as StabilityChart
    from lagrotor.mechanics.running.simulation import SystemRun as SystemRun
    from lagrotor.mechanics.running.state_space import StateSpace as StateSpace
    from lagrotor.mechanics.running.switches import Event as Event
    from lagrotor.mechanics.running.switches import Impact as Impact
    from lagrotor.mechanics.steady_motions import StateEquations as StateEquations
    from lagrotor.mechanics.symmetry import FirstIntegral as FirstIntegral
    from lagrotor.mechanics.symmetry import legendre as legendre
    from lagrotor.mechanics.systems import RobotSystem as RobotSystem
    from lagrotor.mechanics.systems import System as System
    from lagrotor.mechanics.weakly_nonlinear import AveragedMotion as AveragedMotion
    from lagrotor.mechanics.weakly_nonlinear import Oscillation as Oscillation

__getattr__, __dir__, __all__ = face(__name__)
