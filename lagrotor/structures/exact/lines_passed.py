"""Whether a run passed a position where a bar is in line with both its axes: there its constraints are dependent, the motion
has no unique continuation, and an integrator that steps over the place goes on along one of them without notice.

The direction of the bar across an axis, d × r, turns round where the two are in line. If it turns round at both ends from
one state of a run to the next, the place lies between them.
"""

from dataclasses import dataclass, field

import numpy as np

from lagrotor.numerics.segment import RightHandSide, StopError
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.exact_motion import ExactMotion

_IN_LINE = 1e-3  # sine of the angle between a bar and both its axes at which a solver that stops has come to it
_AT_ONCE = 64  # states that are looked at together
_EVERY = 3  # evaluation of a right-hand side is looked at


def bar_in_line(motion: ExactMotion, y: Array) -> str:
    """The words of a state at which a solver stopped as a bar had come into line with both its axes; none where none has."""
    c = motion.c
    across = np.linalg.norm(motion.across(motion.axes_and_rates(y[None])[0, 0]), axis=-1) / (c.R[c.j] * c.ell)
    bars = np.flatnonzero((across < _IN_LINE).all(axis=0))
    return f"bar {bars[0]} comes into line with both its axes" if len(bars) else ""


@dataclass
class LineWatch:
    """States of a run as they come; `check` raises StopError if such a place lies between two of them."""

    motion: ExactMotion
    kept: list[tuple[float, Array]] = field(default_factory=list)
    passed: tuple[float, int] | None = None  # when, which bar

    def keep(self, t: float, y: Array) -> None:
        """The axes of the state y (6 N,) at t; what was kept of a later time belongs to a trial, and is forgotten."""
        while self.kept and self.kept[-1][0] >= t:
            self.kept.pop()
        if self.passed and self.passed[0] > t:
            self.passed = None
        self.kept.append((t, y[: 3 * len(self.motion.c.R)].copy()))
        if len(self.kept) > _AT_ONCE:
            self._look()

    def observe(self, rhs: RightHandSide) -> RightHandSide:
        """The right-hand side, which keeps states of which it is evaluated."""
        evaluations = 0

        def rate(s: float, y: Array) -> list[float]:
            nonlocal evaluations
            evaluations += 1
            if evaluations % _EVERY == 0:
                self.keep(s, y)
            return rhs(s, y)

        return rate if len(self.motion.c.i) else rhs

    def check(self) -> None:
        self._look()
        if self.passed:
            at, bar = self.passed
            raise StopError(at, f"bar {bar} comes into line with both its axes", cause="singular")

    def _look(self) -> None:
        across = self.motion.across(np.array([y for _, y in self.kept]).reshape(len(self.kept), -1, 3))
        turned = np.argwhere(((across[:, 1:] * across[:, :-1]).sum(-1) < 0).all(0))
        if len(turned) and not self.passed:
            self.passed = self.kept[turned[0, 0] + 1][0], int(turned[0, 1])
        del self.kept[:-1]
