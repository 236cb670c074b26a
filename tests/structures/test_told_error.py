"""What a structure's run says of its error is true: random structures beside integrations in 80-bit numbers."""

import warnings
from functools import cache

import numpy as np
import pytest

from lagrotor import Link, Rotor, Structure
from lagrotor.errors import LagrotorError, LagrotorWarning
from lagrotor.numerics import error_estimate
from tests.structures.extended import exact

PLANS = (
    ([(0, 0)], []),
    ([(0, 0), (1, 0)], [(0, 1)]),
    ([(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2)]),
    ([(0, 0), (1, 0), (0.5, 0.8)], [(0, 1), (1, 2), (0, 2)]),
    ([(0, 0), (1, 0), (2, 0.3)], [(0, 1), (1, 2)]),
)
FEW, MANY = 5, 100
Trial = tuple[Structure, dict[str, object], float, np.ndarray]


def drawn(rng: np.random.Generator) -> tuple[Structure, dict[str, object], float]:
    """A structure, its start, and a tolerance."""
    joints, bars = PLANS[rng.integers(len(PLANS))]
    n, size = len(joints), 10 ** rng.uniform(-0.5, 0.5)
    rotor = [Rotor(10 ** rng.uniform(-1, 0.5), size, *10 ** rng.uniform(-1, 0.3, 2)) for _ in joints]
    heavy = rng.random() < 0.5
    link = [Link(1, *(10 ** rng.uniform(-2, 0, 2) if heavy else (0.0, 0.0))) for _ in bars]
    s = Structure(
        [(size * x, size * y) for x, y in joints],
        bars,
        list(rng.choice([-1, 1], n) * 10 ** rng.uniform(-1, 1.5, n)),
        rotor,
        link or Link(),
        gravity=float(rng.choice([0, 9.81])),
        load=list(rng.uniform(0, 1, n)),
        friction=float(rng.choice([0.0, 0.2])),
    )
    tilt, rates = rng.uniform(-0.4, 0.4, (n, 2)), rng.normal(size=(n, 2))
    fastest = max(abs(w) * r.I3 / r.J for w, r in zip(s.spins, s.rotor, strict=True))
    t = rng.uniform(-3, 3) + rng.uniform(1, 3) / max(fastest, 3.0) * np.array([0.0, 0.2, 0.6, 1.0])
    return s, {"t": t, "tilt": tilt, "rates": rates}, float(10 ** rng.uniform(-11, -3))


@cache
def references(seed: int, count: int) -> list[Trial]:
    """Structures that run to the end, with their exact axes."""
    rng, found = np.random.default_rng(seed), list[Trial]()
    while len(found) < count:
        try:
            s, given, tol = drawn(rng)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                run = s.simulate(**given, tol=1e-3)  # type: ignore[arg-type]
        except LagrotorError:  # a tilt that the bars do not allow
            continue
        if not run.ending.early:
            axes, drift = exact(s, run.axes[:, 0], run.rates[:, 0], run.t)
            if drift < 1e-15:  # else neighbours part so fast that 80 bits are too few
                found.append((s, given, tol, axes.astype(float)))
    return found


def outcomes(seed: int, count: int, engine: str = "core") -> list[tuple[float, float, float, bool]]:
    """(estimate, true error, tolerance, whether a warning was given) of each."""
    found = []
    for s, given, tol, axes in references(seed, count):
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            run = s.simulate(**given, tol=tol, engine=engine)  # type: ignore[arg-type]
        error = float(np.linalg.norm(run.axes - axes, axis=-1).max())
        lengths = np.array([bar[2] for bar in s.bars]).reshape(-1, 1)
        assert run.ending.kind == "end" and np.abs(run.link_length - lengths).max(initial=0) < 1e-12
        if not s.friction[0]:
            assert np.ptp(run.energy) < 1e3 * run.error * max(abs(run.energy).max(), 1)
        found.append((run.error, error, tol, any(w.category is LagrotorWarning for w in said)))
    return found


def judge(found: list[tuple[float, float, float, bool]]) -> None:
    assert all(error <= told for told, error, _, _ in found), found
    assert all(said or error <= tol for _, error, tol, said in found), found
    assert np.median([told / max(error, 1e-16) for told, error, _, _ in found]) < 30


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_no_error_is_larger_than_it_is_said_to_be(count: int) -> None:
    judge(outcomes(count, count))


def test_an_estimate_that_is_too_small_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    for constant in ("SAFETY", "LEAST"):
        monkeypatch.setattr(error_estimate, constant, getattr(error_estimate, constant)._replace(value=1e-3))
    with pytest.raises(AssertionError):
        judge(outcomes(FEW, FEW))


def in_units(s: Structure, mass: float, length: float, time: float) -> Structure:
    """The same structure with units of mass, length and time so many times smaller."""
    inertia = mass * length**2
    return Structure(
        [(length * x, length * y) for x, y in s.joints],
        [(i, j, length * ell) for i, j, ell in s.bars],
        [w / time for w in s.spins],
        [Rotor(mass * r.mass, length * r.length, inertia * r.I1, inertia * r.I3) for r in s.rotor],
        [Link(1, mass * b.mass, inertia * b.inertia) for b in s.link] or Link(),
        gravity=s.gravity * length / time**2,
        load=[mass * load for load in s.load],
        friction=[inertia / time * c for c in s.friction],
    )


@pytest.mark.parametrize("units", [(1e6, 1, 1), (1, 1e-6, 1), (1, 1e5, 1), (1, 1, 1e5), (1e-3, 1e2, 1e-4)])
def test_it_is_the_same_motion_in_any_units(units: tuple[float, float, float]) -> None:
    for s, given, tol, _ in references(FEW, FEW):
        run, time = s.simulate(**given, tol=tol), units[2]  # type: ignore[arg-type]
        there = {"t": time * given["t"], "tilt": given["tilt"], "rates": given["rates"] / time}  # type: ignore[operator]
        other = in_units(s, *units).simulate(**there, tol=tol)
        lengths = np.array([bar[2] for bar in s.bars]).reshape(-1, 1)
        assert np.abs(other.link_length / units[1] - lengths).max(initial=0) < 1e-12
        assert np.abs(other.axes - run.axes).max() < run.error + other.error
        assert other.evaluations == pytest.approx(run.evaluations, rel=0.1)
