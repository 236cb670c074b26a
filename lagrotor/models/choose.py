"""The cheapest rung of the ladder that a scene needs: closed form, linear, minimal, spheres."""

from dataclasses import dataclass
from math import inf, pi

from lagrotor.errors import LagrotorError
from lagrotor.models.closed_form import closed_form
from lagrotor.models.linear import MARGIN, linear_error
from lagrotor.models.minimal import MODEL as MINIMAL
from lagrotor.numerics.integrate import TIGHTEST
from lagrotor.pair.scene import Scene

# An integrated run gathers more than its local errors: what is wanted over what the solver is asked for, for a motion that
# the linear one resembles to SMALL, and for a wide one, whose neighbours part.
NEAR, WIDE, SMALL = 10.0, 3e3, 0.01
SHORT = 20.0  # turns after which the error is taken to grow with the run


@dataclass(frozen=True)
class Choice:
    """model: a rung's name. estimate: largest error of an axis over the run (tips: in units of R). reason: a sentence.

    solver_tol: what the solver of an integrated model is to be asked for; 0 for a model without one.
    """

    model: str
    estimate: float
    reason: str
    solver_tol: float = 0.0


def choose(scene: Scene, t_end: float, tol: float, engine: str = "core") -> Choice:
    """The cheapest rung whose axes stay within `tol` (tips: in units of R) of the exact ones from 0 to t_end (s).

    What the closed forms and the linear motion would miss is foreseen from the theory, without integrating; a short run of
    a pair on its bar is integrated at once by engine = "fast", which takes less than foreseeing. The solver of an
    integrated model is asked for less than `tol` by what such motions gather, more for a longer run; a motion that parts
    from its neighbours faster than that may be off by more: see the horizon in `lagrotor stability`.
    """
    turns = sum(map(abs, scene.momenta)) / (2 * scene.rotor.J) * t_end / (2 * pi)
    error, missed = inf, "a run too short to foresee what cheaper ones would miss"
    if engine == "core" or scene.link is None or turns > SHORT:
        try:
            answer = closed_form(scene, t_end, tol)
            if answer.error <= tol:
                return Choice("closed_form", answer.error, f"{answer.reason}; error {answer.error:.1e}")
        except LagrotorError:
            pass
        try:
            error = MARGIN * linear_error(scene, t_end)
            if error <= tol:
                return Choice("linear", error, f"small motion: normal modes, whose next term is {error:.1e}")
            missed = f"normal modes would miss by {error:.1e}"
        except LagrotorError as refusal:
            missed = str(refusal).split(";")[0]
    solver_tol = max(tol / ((NEAR if error < SMALL else WIDE) * max(1.0, turns / SHORT)), TIGHTEST)
    try:
        MINIMAL.start(scene)
    except LagrotorError as refusal:
        return Choice("spheres", tol, f"regular everywhere; {refusal}", solver_tol)
    return Choice("minimal", tol, f"least exact model: bar eliminated, six states; {missed}", solver_tol)
