"""Errors of the closed forms for the slow motion after a shock: the next orders of the averaged motion, computed for the scene.

The pulse is integrated. From its end, on to `duration` after its peak, the normal form about upright (`models.averaged`) through
sixth order gives the mean rates of turning and of x with the next orders that the closed forms leave out; the mean x grows
meanwhile and changes both. How far they are from the closed forms' is derived. An estimate is what the orders left out add, a
geometric series of the ratio of the last two degrees' terms, all added with the same sign, to the lower ones'; the largest ratio
taken and the number of parts are chosen. So the errors are estimates, held in 10,000 random pairs without a miss.
"""

from dataclasses import replace

import numpy as np

from lagrotor.errors import DomainError
from lagrotor.mechanics.canonical.polynomials import total
from lagrotor.models.averaged import Forms, forms_about, normal_start, slow_course, states_at, swing_rates
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import Array, integrate_model, natural_units
from lagrotor.pair.quantities import finite_number
from lagrotor.pair.scene import Scene
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock
from lagrotor.theory.natural_rate import natural_rate

_ORDER = 6
_PHASES = 2 * _ORDER  # of the swing: every harmonic of the form and of its products averages out over them
_PARTS = 8  # of the duration: the largest rate of any is taken
_LEAST = 4  # turns of the swing after the pulse, below which no mean over a run tells the drift from the swing (`mean_error`)
_LOCAL = 1e-7, 1e-10  # errors of the slow motion's integration
_PULSE = 1e-10  # local error of the integration through the pulse
_LARGEST_RATIO = 0.5  # of the last two degrees to the lower ones; beyond, the sum of those left out is no estimate

_WAY_OUT = "take a smaller shock or a shorter duration, or run it with lagrotor.simulate"


def toppling_error(scene: Scene, duration: float) -> float:
    """Error (rad/s) of `toppling_after_shock` as the mean rate from the pulse's end to `duration` s after its peak.

    Raises:
        InputError: as `toppling_after_shock`, or the duration is no finite number.
        DomainError: where the orders of the averaged motion do not fall enough, or below 4 turns of the swing after the pulse.
    """
    return _errors(scene, duration, "toppling_error")[0]


def wander_error(scene: Scene, duration: float) -> float:
    """Error (1/s) of `wander_after_shock` as the mean rate of x from the pulse's end to `duration` s after its peak.

    Raises:
        InputError: as `toppling_error`.
        DomainError: likewise.
    """
    return _errors(scene, duration, "wander_error")[1]


def cancelling_force_error(scene: Scene, duration: float) -> float:
    """How far (N) `cancelling_force` may lie from the force that leaves no mean turning.

    The mean is taken from the pulse's end to `duration` s after its peak. That far on either side `toppling_after_shock` is
    beyond its error, of opposite signs.

    Raises:
        InputError: as `toppling_error`.
        DomainError: as `toppling_error`, and where it is nowhere.
    """
    force = cancelling_force(scene)
    shock = scene.shock
    assert shock is not None

    def with_force(across: float) -> Scene:
        return replace(scene, shock=replace(shock, force=(shock.force[0], across, 0.0)))

    if force == 0:  # nothing along x, nothing to cancel
        _errors(with_force(0.0), duration, "cancelling_force_error")
        return 0.0
    error, least = _errors(with_force(force), duration, "cancelling_force_error")[0], 1e-3 * abs(force)
    slope = np.diff([toppling_after_shock(with_force(force + step)) for step in (-least, least)])[0] / (2 * least)
    apart = max(least, 1.05 * error / abs(slope))
    for _ in range(40):
        if not apart <= abs(force):
            break
        sides = with_force(force - apart), with_force(force + apart)
        rates = [toppling_after_shock(one) for one in sides]
        errors = [_errors(one, duration, "cancelling_force_error")[0] for one in sides]
        short = max(error / abs(rate) for error, rate in zip(errors, rates, strict=True))
        if short <= 1 and rates[0] * rates[1] < 0:
            return apart
        apart *= max(1.1, min(1.1 * short, 10.0))
    raise DomainError(
        f"cancelling_force_error: about {force:.4g} N the error of the turning is as large as the turning: take a smaller shock "
        "or a shorter duration, or lagrotor.models.exact_cancelling_force"
    )


def _errors(scene: Scene, duration: float, where: str) -> tuple[float, float]:
    """Of the rates of turning (rad/s) and of x (1/s)."""
    laws = toppling_after_shock(scene), wander_after_shock(scene)  # which refuse what they do not hold
    duration = finite_number(duration, f"{where}: duration", "s")
    units = natural_units(scene, natural_rate(scene))  # the same for every shock, and the normal form with them
    one, shock = units.scene, units.scene.shock
    assert shock is not None
    span, after = duration * units.rate - (shock.end - shock.at), _LEAST * 2 * np.pi / natural_rate(one)
    if not span > after * (1 - 1e-9):
        raise DomainError(
            f"{where}: duration = {duration:g} s ends before {_LEAST} turns of the swing after the pulse, over which a mean "
            f"is known: take {(shock.end - shock.at + after) / units.rate:.3g} s or more after its peak"
        )
    start = integrate_model(MODEL, one, np.array([0.0, shock.end]), _PULSE).states[-1]
    forms = forms_about(one, 0.0, _ORDER)
    try:
        begin, t = normal_start(one, forms, _ORDER, start), np.linspace(0, span, _PARTS + 1)
        slow, _ = slow_course(forms, _ORDER, begin, t, _LOCAL)
    except DomainError:
        raise DomainError(f"{where}: the motion after the pulse does not stay small: {_WAY_OUT}") from None
    lower, higher = (_largest(forms, part, slow) for part in (range(2, _ORDER - 1), range(_ORDER - 1, _ORDER + 1)))
    ratio = float(np.divide(higher, lower, out=np.where(higher > 0, np.inf, 0.0), where=lower > 0).max())
    if not ratio < _LARGEST_RATIO:
        raise DomainError(
            f"{where}: the last two orders of the averaged motion are {ratio:.2g} of the lower ones, more than "
            f"{_LARGEST_RATIO:g}: {_WAY_OUT}"
        )
    swing = swing_rates(forms)
    turns = np.exp(swing * (2 * np.pi / np.abs(swing).max() * np.arange(_PHASES) / _PHASES)[:, None])
    states = states_at(one, forms, _ORDER, (slow[:, None] * turns).reshape(-1, 6), 0.0)
    x = MODEL.observe(one, states).axes[..., 0].mean(0)
    means = np.stack([states[:, 2], x], axis=1).reshape(len(t), _PHASES, 2).mean(1)
    off = np.abs(np.diff(means, axis=0) / (t[1] - t[0]) * units.rate - laws).max(0)
    turning, wander = off + (off + higher * units.rate) * ratio / (1 - ratio)
    return float(turning), float(wander)


def _largest(forms: Forms, degrees: range, slow: Array) -> Array:
    """The rates of alpha and U that the terms of some degrees give, all added with the same sign, at most along a course."""
    form, at = forms.form, np.abs(slow).max(0)
    terms = total([form.series.part(d) for d in degrees])
    terms = replace(terms, coefficients=np.abs(terms.coefficients))
    slopes = [float(terms.derivative(j).at(at)) for j in (3, 4, 5, 0, 1, 2)]
    slopes[0] = slopes[3] = 0.0  # the swing's own
    return np.asarray(np.abs(form.vectors[[2, 0]]) @ slopes)
