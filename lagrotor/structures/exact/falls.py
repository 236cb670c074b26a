"""When a structure falls on its exact motion."""

from math import inf

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import InputError, IntegrationError
from lagrotor.numerics.arrays import finite_array
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.exact_motion import exact_motion
from lagrotor.structures.exact.written_out import right_hand_side
from lagrotor.structures.resonances import Of, check_kind_of_push


def measured_fall(s: Assembly, push: ArrayLike, longest: float, tol: float = 1e-9, of: Of = "rates") -> float:
    """The time (s) at which an axis of the exact motion first tilts by the sine 0.95, inf where none does.

    Args:
        s: the structure.
        push: the axes' rates (N, 2), rad/s, from upright, or tilts (N, 2) at rest, brought onto the bars.
        longest: s.
        tol: of each step, relative.
        of: "rates" or "tilts", what the push is.

    Raises:
        InputError: for tilts from 0.95 on, and what is no push.
        IntegrationError: where the solver fails.
    """
    from scipy.integrate import solve_ivp

    motion, N = exact_motion(s), len(s.joints)
    rate = motion.c.rate
    check_kind_of_push(of)
    given = finite_array("measured_fall: push", push, (N, 2))
    axes, rates = np.array(motion.c.upright), np.zeros((N, 3))
    if of == "tilts":
        if not np.hypot(*given.T).max() < 0.95:
            raise InputError("measured_fall: push: an axis is tilted by the sine 0.95 or more at the start")
        axes = np.column_stack([given, np.sqrt(1 - np.square(given).sum(1))])
    else:
        rates[:, :2] = given / rate
    start = motion.project(np.concatenate([axes, rates]).ravel())

    def fallen(_: float, y: Array) -> float:
        return float(np.hypot(*motion.axes_and_rates(y)[0, 0, :, :2].T).max()) - 0.95

    fallen.terminal = True  # type: ignore[attr-defined]
    span, tolerances = (0, longest * rate), {"rtol": tol, "atol": 1e-3 * tol}
    run = solve_ivp(right_hand_side(motion), span, start, events=fallen, method="DOP853", **tolerances)
    if run.status < 0:
        raise IntegrationError(f"measured_fall: {run.message}")
    return float(run.t[-1]) / rate if run.status == 1 else inf
