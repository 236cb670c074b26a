"""Errors of the closed forms for the slow motion after a shock: the next orders of the averaged motion, computed for the scene.

The pulse is integrated. From its end the normal form about upright (`models.averaged`) through sixth order gives the mean rates
of turning and of x with the next orders that the closed forms leave out, over the whole duration, in which the mean x grows and
changes both: how far they are from the closed forms' is known then. The terms of the last two degrees, all added with the same
sign, are a ratio of the lower ones; the orders that are left out are estimated to go on as a geometric series of that ratio.
"""

from dataclasses import replace

import numpy as np

from lagrotor.errors import DomainError
from lagrotor.mechanics.canonical.polynomials import total
from lagrotor.models.averaged import Forms, forms_about, normal_start, slow_course, states_at, swing_rates
from lagrotor.models.minimal import MODEL
from lagrotor.models.model import Array, integrate_model, natural_units
from lagrotor.pair.scene import Scene
from lagrotor.theory.drift_after_shock import cancelling_force, toppling_after_shock, wander_after_shock
from lagrotor.theory.natural_rate import natural_rate

_ORDER = 6
_PHASES = 12  # of the swing, over which a mean is taken
_PARTS = 8  # of the duration
_LOCAL = 1e-7, 1e-10  # errors of the slow motion's integration
_PULSE = 1e-10  # local error of the integration through the pulse
_SLOWEST = 0.5  # ratio beyond which the orders do not fall


def toppling_error(scene: Scene, duration: float) -> float:
    """Error (rad/s) of `toppling_after_shock` as the mean rate over `duration` s from the pulse's peak.

    Raises:
        InputError: as `toppling_after_shock`.
        DomainError: where the orders of the averaged motion do not fall, or the duration ends within the pulse.
    """
    return _errors(scene, duration, "toppling_error")[0]


def wander_error(scene: Scene, duration: float) -> float:
    """Error (1/s) of `wander_after_shock` as the mean rate of x over `duration` s from the pulse's peak.

    Raises:
        InputError: as `toppling_error`.
        DomainError: likewise.
    """
    return _errors(scene, duration, "wander_error")[1]


def cancelling_force_error(scene: Scene, duration: float) -> float:
    """How far (N) `cancelling_force` may lie from the force that leaves no mean turning over `duration` s after the pulse's peak.

    That far on either side `toppling_after_shock` is beyond its error, of opposite signs.

    Raises:
        InputError: as `toppling_error`.
        DomainError: as `toppling_error`, and where it is nowhere.
    """
    force = cancelling_force(scene)
    shock = scene.shock
    assert shock is not None

    def shocked(across: float) -> Scene:
        return replace(scene, shock=replace(shock, force=(shock.force[0], across, 0.0)))

    apart = 1e-3 * abs(force)
    for _ in range(40):
        sides = shocked(force - apart), shocked(force + apart)
        rates = [toppling_after_shock(one) for one in sides]
        errors = [_errors(one, duration, "cancelling_force_error")[0] for one in sides]
        short = max(error / abs(rate) for error, rate in zip(errors, rates, strict=True))
        if short <= 1 and rates[0] * rates[1] < 0:
            return apart
        if not apart <= abs(force):
            break
        apart *= max(1.1, min(1.1 * short, 10.0))
    raise DomainError(
        f"cancelling_force_error: about {force:.4g} N the error of the turning is as large as the turning: take a smaller shock "
        "or a shorter duration, or lagrotor.models.exact_cancelling_force"
    )


def _errors(scene: Scene, duration: float, where: str) -> tuple[float, float]:
    """Of the rates of turning (rad/s) and of x (1/s)."""
    laws = toppling_after_shock(scene), wander_after_shock(scene)  # which refuse what they do not hold
    units = natural_units(scene, natural_rate(scene))  # the same for every shock, and the normal form with them
    one, shock = units.scene, units.scene.shock
    assert shock is not None
    span = duration * units.rate - (shock.end - shock.at)
    if not span > 0:
        raise DomainError(
            f"{where}: duration = {duration:g} s ends within the pulse, {(shock.end - shock.at) / units.rate:.3g} s after its "
            "peak: take a longer one"
        )
    start = integrate_model(MODEL, one, np.array([0.0, shock.end]), _PULSE).states[-1]
    forms = forms_about(one, 0.0, _ORDER)
    try:
        begin, t = normal_start(one, forms, _ORDER, start), np.linspace(0, span, _PARTS + 1)
        slow, _ = slow_course(forms, _ORDER, begin, t, _LOCAL)
    except DomainError as error:
        raise DomainError(f"{where}: {error}") from None
    lower, higher = (_largest(forms, part, slow) for part in (range(2, _ORDER - 1), range(_ORDER - 1, _ORDER + 1)))
    ratio = float((higher / lower).max())
    if not ratio < _SLOWEST:
        raise DomainError(
            f"{where}: the orders of the averaged motion fall by {ratio:.2g} each, less than by {_SLOWEST:g}: it is not small; "
            "take a smaller shock or a shorter duration, or run it with lagrotor.simulate"
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
