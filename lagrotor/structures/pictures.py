"""Pictures of a structure: its plan and its roots."""

from math import inf, pi

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lagrotor.drawing.run_figure import RunFigure
from lagrotor.drawing.style import HALO, MODEL_COLOUR, PAPER_COLOUR, paper_style
from lagrotor.drawing.wheel import BAR, INK, MARK, ROTORS
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.small_motion import small_motion
from lagrotor.structures.standing import stands


def draw_plan(panel: Axes, s: Assembly) -> None:
    """Draw the joints from above, with bars, braces (dashed) and spins.

    Parameters
    ----------
    panel : Axes
        The panel to draw on.
    s : Assembly
        The structure.
    """
    for i, j, _ in s.bars:
        panel.plot(*zip(s.joints[i], s.joints[j], strict=True), color=BAR, linewidth=4, zorder=1)
    for brace in s.braces:
        end = s.joints[brace.to] if isinstance(brace.to, int) else brace.to[:2]
        panel.plot(*zip(s.joints[brace.tip], end, strict=True), "--", color=MARK, linewidth=1.5, zorder=1)
    fastest = max(map(abs, s.spins)) or 1.0
    for i, ((x, y), spin) in enumerate(zip(s.joints, s.spins, strict=True)):
        ink = BAR if spin == 0 else ROTORS[spin < 0]
        panel.plot(x, y, "o", color=ink, markersize=9, mfc=ink if spin else "white", zorder=2)
        if len(s.joints) <= 16:
            label, (dx, dy) = f"{spin:.4g}".replace("-", "−"), _clear_direction(s, i)
            panel.annotate(
                label, (x, y), (9 * dx, 9 * dy), textcoords="offset points", color=INK, path_effects=HALO,
                ha="center" if abs(dx) < 0.3 else "left" if dx > 0 else "right",
                va="center" if abs(dy) < 0.3 else "bottom" if dy > 0 else "top",
            )  # fmt: skip
        panel.plot(x, y, "o", color=ink, markersize=9 + 6 * abs(spin) / fastest, fillstyle="none", zorder=2)
    panel.set(xlabel="x (m)", ylabel="y (m)", title="From above, spins in rad/s", aspect="equal", adjustable="datalim")
    panel.margins(0.25)


def _clear_direction(s: Assembly, rotor: int) -> Array:
    """Return the unit vector in the middle of the widest angle between bars and braces at a rotor."""
    ends = [s.joints[j if i == rotor else i] for i, j, _ in s.bars if rotor in (i, j)]
    ends += [s.joints[b.to] if isinstance(b.to, int) else b.to[:2] for b in s.braces if b.tip == rotor]
    ends += [s.joints[b.tip] for b in s.braces if b.to == rotor]
    if not ends:
        return np.array([0.0, 1.0])
    x, y = np.transpose(ends) - np.array(s.joints[rotor])[:, None]
    angles = np.sort(np.arctan2(y, x))
    gaps = np.diff(angles, append=angles[0] + 2 * pi)
    middle = angles + gaps / 2
    widest = middle[gaps > gaps.max() - 1e-9]
    best = widest[np.argmax(np.sin(widest) + 1e-3 * np.cos(widest))]  # the highest of equal ones
    return np.array([np.cos(best), np.sin(best)])


def structure_picture(s: Assembly) -> Figure:
    """Draw the plan and the roots s = growth + i rate of small motion about upright."""
    with paper_style():
        figure = RunFigure(figsize=(9.0, 4.6))
        plan, roots = figure.subplots(1, 2, width_ratios=(1.2, 1))
        draw_plan(plan, s)
        roots.set(xlabel="growth (1/s)", ylabel="rate (rad/s)", title="Roots of small motion")
        if not s.natural:
            roots.set_axis_off()
            reason = "None about upright:\na bar does not have\nits upright length"
            roots.text(0.5, 0.5, reason, ha="center", va="center", transform=roots.transAxes)
            return figure
        values, standing = small_motion(s).roots, stands(s)
        for grows, ink in ((False, MODEL_COLOUR), (True, PAPER_COLOUR)):
            selection = values[(values.real > 0) == grows]
            roots.plot(selection.real, selection.imag, "o", color=ink, markersize=6)
        roots.margins(0.15)
        roots.axvline(0, color=INK, linewidth=0.8)
        factor = standing.critical_spin
        least = f"; critical factor on the spins: {factor:.4g}" if factor else ""
        least = "; no multiple of these spins stabilises it" if factor == inf else least
        figure.suptitle(("Stable" if standing.stands else "Unstable") + least)
    return figure
