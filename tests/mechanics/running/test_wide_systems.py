"""The promise of a run on random systems of ten kinds: its error is at most what is estimated, and tol is kept or announced.

Against motions known to 60 bits, made in `references`; the size of a state is what `SystemRun` says it is.
"""

import warnings
from dataclasses import dataclass

import numpy as np
import pytest

from lagrotor.errors import LagrotorWarning
from lagrotor.numerics import error_estimate
from tests.mechanics.running import references
from tests.mechanics.running.references import EXTENDED, KINDS, drawn

pytestmark = pytest.mark.skipif(
    not EXTENDED, reason="the references need numbers of 64 bits, which this machine has not"
)
ROUNDED = 1e-12  # an error at one of the times that rounding alone may make
WARNED = 2.0  # times its estimate an error may be where the run warns that tol is not kept: neighbouring motions part


@dataclass(frozen=True)
class Outcome:
    """What a run promised, and what it is."""

    name: str
    true: float
    error: float
    kept: bool
    announced: bool
    everywhere: bool


def outcome(seed: int, engine: str = "core") -> Outcome:
    given = drawn(seed)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = given.system.simulate(given.values, given.q, given.v, given.t, given.tol, engine)
    announced = any(issubclass(w.category, LagrotorWarning) for w in caught)
    exact = given.exact()[: len(run.t)]
    true = run.scales.distance(np.hstack([run.q, run.v]), exact)
    sizes = np.abs(exact).max(0)
    assert (run.scales.sizes < 1e4 * np.maximum(sizes, sizes.max() / 1e3)).all()  # no error is hidden in a size
    everywhere = bool((true <= (WARNED if announced else 1.0) * np.maximum(run.errors, ROUNDED)).all())
    return Outcome(
        f"{given.name} {seed}", float(true.max()), run.error, bool(true.max() <= given.tol), announced, everywhere
    )


def held(outcomes: list[Outcome]) -> list[str]:
    """Those that break the promise."""
    return [
        str(o)
        for o in outcomes
        if o.true > (WARNED if o.announced else 1.0) * max(o.error, ROUNDED)
        or not (o.everywhere and (o.kept or o.announced))
    ]


@pytest.mark.parametrize("kind", range(len(KINDS)), ids=lambda i: KINDS[i].__name__)
def test_one_of_each_kind_keeps_its_promise(kind: int) -> None:
    assert held([outcome(1200 + kind)]) == []


def test_an_error_is_known_at_many_times_and_would_be_missed_if_it_were_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seed 9132: a pendulum whose two runs part no farther from 15 to 60 s, while its error grows tenfold."""
    sparse, fine = references._times, np.arange(65) / 64
    monkeypatch.setattr(
        references, "_times", lambda *args: np.union1d(t := sparse(*args), t[0] + (t[-1] - t[0]) * fine)
    )
    assert held([outcome(seed) for seed in (1202, 1203, 1204, 9132)]) == []
    monkeypatch.setattr(error_estimate, "SAFETY", error_estimate.SAFETY._replace(value=0.05))  # twin
    assert held([outcome(seed) for seed in (1202, 1203, 1204)])


def test_a_run_that_promised_too_much_would_be_seen() -> None:
    """The twin: an error a hundred times as small as estimated, and a miss without a word."""
    good = outcome(1211)
    assert held([Outcome(good.name, 200 * good.error, good.error, True, False, True)])
    assert held([Outcome(good.name, good.true, good.error, False, False, True)])


@pytest.mark.slow
def test_three_hundred_and_sixty_random_systems_keep_their_promise_and_it_is_tight() -> None:
    outcomes = [outcome(seed) for seed in range(360)]
    assert held(outcomes) == []
    assert np.median([o.error / o.true for o in outcomes if o.true > 1e-13]) < 25


@pytest.mark.slow
def test_the_fast_engine_keeps_it_too() -> None:
    pytest.importorskip("heyoka")
    outcomes = [outcome(seed, "fast") for seed in range(400, 448)]
    assert held(outcomes) == []
