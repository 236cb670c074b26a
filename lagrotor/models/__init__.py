"""The models of the pair, from closed forms to rigid bodies on springs, and their choice by a tolerance.

Data pass through these modules in this order:

- `simulate` takes a `Scene`, times, a model and a tolerance. `model="auto"` takes the cheapest whose error is below `tol`.
- `closed_form_model`, `linear` and `averaged` evaluate closed forms and normal modes. `minimal`, `spheres` and `euler` each
  define a `Model`: a generated program (`programs`), a start, and the axes of its states.
- `model.py` integrates a `Model` in natural units and checks the conservation laws. The result is a `Trajectory`.
- `sweeps` runs many scenes at once; `spring_link` is the paper's own simulator of rigid bodies and springs.
- `orbits` finds periodic orbits by shooting, with their Floquet multipliers. `mean_motion` measures drifts on exact runs.

A new model is a module with a `Model`, and a row in `simulate.py`.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.models.linear import shock_response_error as shock_response_error
    from lagrotor.models.mean_motion import cancelling_force_error as cancelling_force_error
    from lagrotor.models.mean_motion import exact_cancelling_force as exact_cancelling_force
    from lagrotor.models.mean_motion import guiding_centre_error as guiding_centre_error
    from lagrotor.models.mean_motion import mean_over as mean_over
    from lagrotor.models.mean_motion import run_after as run_after
    from lagrotor.models.mean_motion import time_to_reach_error as time_to_reach_error
    from lagrotor.models.mean_motion import time_to_wander as time_to_wander
    from lagrotor.models.mean_motion import toppling_error as toppling_error
    from lagrotor.models.mean_motion import turning_rate as turning_rate
    from lagrotor.models.mean_motion import wander_error as wander_error
    from lagrotor.models.mean_motion import wandering_rate as wandering_rate
    from lagrotor.models.orbits.floquet import slow_frequency_error as slow_frequency_error
    from lagrotor.models.orbits.shooting import OrbitFamily as OrbitFamily
    from lagrotor.models.orbits.shooting import exact_orbit as exact_orbit
    from lagrotor.models.orbits.shooting import trace_family as trace_family
    from lagrotor.models.orbits.shooting import upright_orbit as upright_orbit
    from lagrotor.models.spring_link.rigid_body import RigidBody as RigidBody
    from lagrotor.models.spring_link.rigid_body import finite_rotation as finite_rotation
    from lagrotor.models.spring_link.run import run_solver as run_solver
    from lagrotor.models.spring_link.run import run_steps as run_steps
    from lagrotor.models.spring_link.system import RigidBodySystem as RigidBodySystem
    from lagrotor.models.spring_link.system import link_force as link_force
    from lagrotor.models.spring_link.system import paper_system as paper_system
    from lagrotor.models.spring_link.system import step_limit as step_limit
    from lagrotor.models.sweeps.ensemble import Ensemble as Ensemble

__getattr__, __dir__, __all__ = face(__name__)
