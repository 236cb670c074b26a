"""Closed forms of the pair, each with its error.

- `natural_frequency` and `natural_rate`: the frequency of small motion of a pair of any two spins.
- `paired_precession`: the precession of opposite spins as a series (`series`), its closed forms (`closed_forms`), their errors
  (`remainder`) and its stability (`stability`). `rate_shift` has other orbits about the upright position.
- `impulse_response` and `shock_response`: the linear response to an impulse and to a Gaussian pulse.
- `drift_after_shock`, `averaged_motion`, `charged_particle`: opposite spins averaged over the fast precession, and
  the slow motion of a scene. `toppling` and `parallel_twist` treat motions with parallel axes.

A `ClosedForm` (`closed_form`) joins expressions with their arguments, domain and order, and gives numpy functions.
A script in `derivations/` derives each formula; a new formula comes with its script.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.theory.averaged_motion import SlowMotion as SlowMotion
    from lagrotor.theory.averaged_motion import slow_frequency as slow_frequency
    from lagrotor.theory.averaged_motion import slow_motion as slow_motion
    from lagrotor.theory.averaged_motion import time_to_reach as time_to_reach
    from lagrotor.theory.averaged_motion import turns_back as turns_back
    from lagrotor.theory.charged_particle import GuidingCentre as GuidingCentre
    from lagrotor.theory.charged_particle import guiding_centre as guiding_centre
    from lagrotor.theory.charged_particle import leaning_field as leaning_field
    from lagrotor.theory.charged_particle import leaning_state as leaning_state
    from lagrotor.theory.closed_form import ClosedForm as ClosedForm
    from lagrotor.theory.drift_after_shock import averaged_hamiltonian as averaged_hamiltonian
    from lagrotor.theory.drift_after_shock import cancelling_impulse as cancelling_impulse
    from lagrotor.theory.drift_after_shock import shock_toppling as shock_toppling
    from lagrotor.theory.drift_after_shock import shock_wander as shock_wander
    from lagrotor.theory.drift_after_shock import slow_rates as slow_rates
    from lagrotor.theory.drift_after_shock import wander_after_shock as wander_after_shock
    from lagrotor.theory.impulse_response import impulse_matrices as impulse_matrices
    from lagrotor.theory.impulse_response import shock_displacement as shock_displacement
    from lagrotor.theory.impulse_response import shock_energy as shock_energy
    from lagrotor.theory.natural_frequency import free_precession_rate as free_precession_rate
    from lagrotor.theory.natural_frequency import linear_pair as linear_pair
    from lagrotor.theory.natural_frequency import pair_precession_rate as pair_precession_rate
    from lagrotor.theory.natural_rate import natural_rate_error as natural_rate_error
    from lagrotor.theory.paired_precession.series import paired_series as paired_series
    from lagrotor.theory.paired_precession.series_orbit import PrecessionOrbit as PrecessionOrbit
    from lagrotor.theory.paired_precession.series_orbit import series_orbit as series_orbit
    from lagrotor.theory.paired_precession.stability import elliptic_edge as elliptic_edge
    from lagrotor.theory.paired_precession.stability import exponent_series as exponent_series
    from lagrotor.theory.paired_precession.stability import growth_squared as growth_squared
    from lagrotor.theory.parallel_twist import lyapunov_criterion as lyapunov_criterion
    from lagrotor.theory.parallel_twist import parallel_scene as parallel_scene
    from lagrotor.theory.parallel_twist import twist_bounded as twist_bounded
    from lagrotor.theory.parallel_twist import twist_growth as twist_growth
    from lagrotor.theory.parallel_twist import twist_growth_error as twist_growth_error
    from lagrotor.theory.parallel_twist import twist_multiplier_growth as twist_multiplier_growth
    from lagrotor.theory.rate_shift import azimuth_drift as azimuth_drift
    from lagrotor.theory.rate_shift import frequency_shift as frequency_shift
    from lagrotor.theory.toppling import toppling_growth as toppling_growth
    from lagrotor.theory.toppling import toppling_polynomial as toppling_polynomial
    from lagrotor.theory.toppling import toppling_threshold as toppling_threshold
    from lagrotor.theory.toppling import twisted_lagrangian as twisted_lagrangian

__getattr__, __dir__, __all__ = face(__name__)
