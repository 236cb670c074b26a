"""Runs that know their error: what the motion conserves, bars kept for long, and runs that take the same steps."""

from dataclasses import replace

import numpy as np
import pytest

from lagrotor import Link, Scene, Shock, paired_scene, simulate
from lagrotor.errors import IntegrationError, LagrotorWarning
from lagrotor.models import euler, minimal
from lagrotor.models import simulate as simulating
from lagrotor.models.model import natural_units
from lagrotor.numerics import error_estimate
from tests.models.one_integration import observed

SHOCKED = Scene(
    (10, -9), link=Link(0.8, 0.3, 0.05), shock=Shock((40, -11, 5), 0.6, 0.05, 2), rates=((0.4, 1, 0), (0.4, -0.5, 0))
)
T = np.linspace(0, 3, 31)


def set_to(monkeypatch: pytest.MonkeyPatch, constant: str, value: float) -> None:
    monkeypatch.setattr(error_estimate, constant, getattr(error_estimate, constant)._replace(value=value))


def test_a_run_that_does_not_conserve_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """A gyroscopic force two per cent too small: tolerances agree, the momentum about the joint line does not."""
    assert simulate(SHOCKED, T, "minimal", 1e-9).error < 1e-6
    right = minimal.MODEL.kind

    def wrong(scene: Scene, driven: bool):  # type: ignore[no-untyped-def]
        kind, values = right(scene, driven)
        return kind, (*values[:-1], 0.98 * values[-1])

    monkeypatch.setitem(simulating.MODELS, "minimal", replace(minimal.MODEL, kind=wrong))
    with pytest.raises(IntegrationError, match=r"minimal: .* the run followed another motion"):
        simulate(SHOCKED, T, "minimal", 1e-9)
    set_to(monkeypatch, "KEPT", np.inf)  # unchecked, what both are off conserving is in the error
    with pytest.warns(LagrotorWarning, match="minimal does not keep tol"):
        assert simulate(SHOCKED, T, "minimal", 1e-9).error > 1e-3
    monkeypatch.setattr(
        error_estimate, "_shared_error_factor", lambda *_: 1.0
    )  # twin: unheard, it passes with a small error estimate
    assert simulate(SHOCKED, T, "minimal", 1e-9).error < 1e-9


def test_euler_angles_keep_the_bar_for_long() -> None:
    turns = 20
    scene = paired_scene(Scene((10, -10), link=Link(1.0, 0.3, 0.02)), 0.204)
    times = np.linspace(0, 0.8545 * turns, 101)
    # An azimuth of so many turns is rounded to about 10⁻¹⁵ of them.
    assert np.abs(simulate(scene, times, "euler", 1e-9).link_length - 1).max() < 2e-15 * turns
    units = natural_units(scene)  # twin: not brought back onto the bar, they lose it
    loose = observed(replace(euler.MODEL, projection=None), units.scene, times * units.rate, 1e-9).axes
    assert np.abs(np.linalg.norm([1, 0, 0] + loose[1] - loose[0], axis=-1) - 1).max() > 1e-12


def test_runs_that_take_the_same_steps_are_not_known_to_be_right(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stretch so short that loose tolerances allow a few steps only, the same for both: their difference says nothing."""
    times = np.array([0.0, 2e-5])
    exact = simulate(SHOCKED, times, "spheres", 1e-13).axes
    run = simulate(SHOCKED, times, "minimal", 1e-2)
    error = np.linalg.norm(run.axes - exact, axis=-1).max()
    assert error < run.error < 1e-4
    set_to(monkeypatch, "LEAST", 0.0)
    assert simulate(SHOCKED, times, "minimal", 1e-2).error < error  # twin
