"""What a run refuses at its door: in words, none accepted for what it is not, none without an end."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp

from lagrotor.errors import InputError, IntegrationError, SingularError
from lagrotor.mechanics import Event, Impact, System, coordinates, t

m, length, e = sp.symbols("m length e", positive=True)
c = coordinates("theta")
x, v = c.q[0], c.v[0]
T = np.linspace(0, 1, 3)
pendulum = System(c, m * length**2 * v**2 / 2 + 10 * m * length * sp.cos(x))
plane = coordinates("x y")
bound = System(plane, m * (plane.v[0] ** 2 + plane.v[1] ** 2) / 2, (plane.q[0] ** 2 + plane.q[1] ** 2 - length**2,))


def run(**changed: Any) -> Any:
    given: dict[str, Any] = {"values": {m: 1, length: 1}, "q0": (0.1,), "v0": (0,), "t": T}
    return pendulum.simulate(**(given | changed))


def forced(force: sp.Expr) -> System:
    return System(c, v**2 / 2, forces=(force,))


REFUSED: dict[str, tuple[Callable[[], Any], str]] = {
    "misspelt": (lambda: run(values={m: 1, "lenght": 1}), r"length without a value.*lenght\?"),
    "text": (lambda: run(values={m: 1, length: "1"}), "length = '1' must be a number"),
    "truth": (lambda: run(values={m: True, length: 1}), "m = True must be a number"),
    "coordinate": (lambda: run(values={m: 1, length: 1, x: 3}), "theta a value, which varies in time"),
    "twice": (lambda: run(values={m: 1, length: 1, "m": 3}), "values give m twice"),
    "strangers": (
        lambda: run(values={m: 1, length: 1, "b": 1, "a": 1}),
        "values name a, b, which .* its symbols are length, m: leave them out",
    ),
    "overflow": (lambda: forced(x).simulate({}, (1e300,), (1e300,), T), "the energy overflows at the start"),
    "no energy": (lambda: System(c, v**2 / 2 - sp.sqrt(x - 1)).simulate({}, (0,), (0,), T), "energy has no real value"),
    "progress": (lambda: pendulum.simulate({m: 1, length: 1}, (0.1,), (0,), T, progress=5), "progress = 5 must be"),
    "complex start": (lambda: run(q0=np.array([0.1 + 1j])), "must be 1 numbers"),
    "start of texts": (lambda: run(q0=["0.1"]), "must be 1 numbers"),
    "times of texts": (lambda: run(t=["0", "1"]), "must be an array of times"),
    "complex times": (lambda: run(t=np.array([0, 1 + 1j])), "must be an array of times"),
    "dates": (lambda: run(t=np.array(["2020-01-01"], dtype="datetime64[s]")), "must be an array of times"),
    "no section": (lambda: Event(sp.S.One), "which nothing crosses"),
    "velocities": (lambda: Event(x, -v), "must be a tuple"),  # type: ignore[arg-type]
    "no event": (lambda: run(events=x), "must be Event"),
    "gap of a velocity": (lambda: run(events=Impact(v)), "may depend only on q and t"),
    "gap of the time": (lambda: run(events=Impact(t)), "contains no coordinate"),
    "restitution of 2": (lambda: Impact(x, 2), "must lie between 0"),
    "direction": (lambda: Event(x, direction=2), "direction"),
    "velocities after": (lambda: run(events=Event(x, (v, v))), "has 2 entries, but the system has 1"),
    "fast events": (lambda: run(engine="fast", events=Event(x)), "takes no events"),
    "letter of an event": (lambda: run(events=Impact(x, e)), "e without a value"),
    "neighbours of impacts": (lambda: run(events=Impact(x)).lyapunov(), "jump"),
    "neighbours of a sample": (lambda: run(t=[0.0]).lyapunov(), "one sample"),
    "not finite": (lambda: run(values={m: np.nan, length: 1}), "must be finite"),
    "two numbers": (lambda: run(q0=(1, 2)), "one for each coordinate"),
    "infinite": (lambda: run(v0=(np.inf,)), "a finite number"),
    "times that stand": (lambda: run(t=[0, 1, 1]), "increasing"),
    "tolerance": (lambda: run(tol=1e-20), "tol"),
    "engine": (lambda: run(engine="warp"), "is neither core nor fast"),
    "crossing of a sample": (lambda: run().at([0.0]).crossings(x), "of one sample crosses"),
    "crossing direction": (lambda: run().crossings(x, 2), "direction"),
    "frames": (lambda: run().animate("film.gif", lines=[[(0, 0, 0), (0, 0, x)]], fps=0), "must lie between 1 and"),
    "points": (lambda: run().animate("film.gif", lines=[[(0, 0), (0, x)]]), "must be 3 expressions"),
    "lines": (lambda: run().animate("film.gif", lines=[0]), "is no line"),
    "nothing to film": (lambda: run().animate("film.gif"), "give lines="),
    "same": (lambda: pendulum.same_as("pendulum"), "no System"),
    "names": (lambda: coordinates(3), "must be names"),
    "conserved": (lambda: pendulum.conserved("x"), "f = 'x' is no expression"),
    "gauge": (lambda: pendulum.noether((0,), gauge="x"), "gauge = 'x' is no expression"),
    "noether": (lambda: pendulum.noether("x"), "one component"),
    "coordinates": (lambda: pendulum.in_coordinates(coordinates("x"), {x: "x"}), "theta = 'x' is no expression"),
    "consistent": (lambda: bound.consistent({}, (1, 0), (0, 0)), "consistent: length, m without a value"),
    "restitution": (lambda: run(values={m: 1, length: 1, e: 2}, events=Impact(x, e)), "restitution e is 2"),
    "gap": (lambda: run(q0=(-0.1,), events=Impact(x)), r"gap theta is -0\.1"),
    "after": (lambda: run().after("x"), "must be a time"),
    "integral": (
        lambda: forced(sp.Integral(sp.sin(m), (m, 0, x))).simulate({}, (0.1,), (0,), T),
        "write it with elementary",
    ),
}


SINGULAR = {
    "not regular in y_dot; use fewer": System(plane, plane.v[0] ** 2 / 2 - plane.q[1] ** 2),
}


@pytest.mark.parametrize("words", SINGULAR)
def test_a_system_without_one_acceleration_is_refused(words: str) -> None:
    values = {} if "regular" in words else {m: 1, length: 1}
    with pytest.raises(SingularError, match=words):
        SINGULAR[words].simulate(values, (1, 0), (0, 0), T)


@pytest.mark.parametrize("name", REFUSED)
def test_what_makes_no_sense_is_refused_in_words(name: str) -> None:
    act, words = REFUSED[name]
    with pytest.raises(InputError, match=words):
        act()


def test_what_makes_sense_is_run() -> None:
    """The twin: each of these is near to one that is refused."""
    plain = run().q
    for values in ({"m": 1, length: 1.0}, {m: sp.Rational(1), length: np.float32(1)}, {m: 1, length: 1, e: 0.5}):
        assert np.array_equal(run(values=values).q, plain)
    assert run(q0=(sp.Rational(1, 10),), t=range(3)).t[-1] == 2
    assert run(t=[0, 1e-300]).q[-1] == pytest.approx(0.1)
    assert run(values={"m": 1, "length": 1, "e": 1}, events=Impact(x, e)).ending.kind == "end"


@pytest.mark.parametrize("system", [forced(sp.sqrt(x - 1)), forced(1 / (x - x.xreplace({x: sp.Rational(1, 10)})))])
def test_a_start_without_a_finite_acceleration_is_refused_at_once(system: System) -> None:
    with pytest.raises(IntegrationError, match="not finite"):
        system.simulate({}, (0.1,), (0,), T)


def test_at_rest_where_a_force_of_the_place_jumps() -> None:
    """x'' = −sign x stays, x'' = sign x leaves to either side: said of both; passed with a velocity both are run."""
    for force, words in ((-sp.sign(x), "stays on theta = 0"), (sp.sign(x), "either side")):
        with pytest.warns(UserWarning, match=words):
            assert forced(force).simulate({}, (0,), (0,), T).ending.reason
        assert forced(force).simulate({}, (0,), (1,), T).ending.kind == "end"


def test_velocities_of_an_event_that_are_not_finite_end_the_run_there() -> None:
    """The root is of a negative number; the twin's is not."""
    for below, kind in ((100, "stopped"), (-100, "end")):
        event = Event(x, (sp.sqrt(v**2 - below),))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ended = forced(-x).simulate({}, (1,), (0,), np.linspace(0, 2, 9), events=event)
        assert ended.ending.kind == kind and np.isfinite(ended.q).all()
    assert ended.t[-1] == 2


def test_a_run_of_more_turns_than_rounding_leaves_is_refused_at_once() -> None:
    with pytest.raises(IntegrationError, match=r"has \d\.\de\+\d+ turns, over which rounding errors exceed the states"):
        forced(-x).simulate({}, (1.0,), (0.0,), [0.0, 1e300])
