"""The cheapest model that a scene needs: closed form, linear, minimal, spheres."""

from dataclasses import dataclass
from math import inf, pi

from lagrotor.errors import LagrotorError
from lagrotor.models.closed_form_model import closed_form
from lagrotor.models.estimate_constants import SHORT
from lagrotor.models.integrated import check_range
from lagrotor.models.linear import linear_error
from lagrotor.models.minimal import MODEL as MINIMAL
from lagrotor.models.natural_units import typical_rate
from lagrotor.pair.scene import Scene
from lagrotor.shown import scientific


@dataclass(frozen=True)
class Choice:
    """model: its name. estimate: largest error of an axis over the run (tips: in units of R). reason: a sentence."""

    model: str
    estimate: float
    reason: str


def choose(scene: Scene, t_end: float, tol: float, engine: str = "core") -> Choice:
    """The cheapest model whose axes stay within `tol` (tips: in units of R) of the exact ones from 0 to t_end (s).

    The errors of the closed forms and of the linear model are estimated analytically; no integration is needed. A short run
    of a pair with its bar takes engine = "fast" less time than that estimate, and is integrated at once. An integrated
    model is held to `tol` while it runs: see `lagrotor.models.estimated`.
    """
    turns, error, missed = (
        typical_rate(scene) * t_end / (2 * pi),
        inf,
        "a run too short to estimate the cheaper ones' errors",
    )
    if engine == "core" or scene.link is None or turns > SHORT:
        try:
            answer = closed_form(scene, t_end, tol)
            if answer.error <= tol:
                return Choice("closed_form", answer.error, f"{answer.reason}; error {scientific(answer.error, 1)}")
        except LagrotorError:
            pass
        try:
            error = linear_error(scene, t_end)
            if error <= tol:
                return Choice(
                    "linear", error, f"small motion: normal modes, whose next terms are at most {scientific(error, 1)}"
                )
            missed = f"normal modes have an error of {scientific(error, 1)}"
        except LagrotorError as refusal:
            missed = str(refusal).split(";")[0]
    try:
        check_range(MINIMAL, scene)
    except LagrotorError as refusal:
        return Choice("spheres", tol, f"regular everywhere; {refusal}")
    return Choice("minimal", tol, f"least exact model: bar eliminated, six states; {missed}")
