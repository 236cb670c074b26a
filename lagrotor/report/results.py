"""The results that matter most, each with the numbers of its own run: what the page and the Markdown begin with."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from lagrotor.pair.symbols import K, m
from lagrotor.paper.ledger import Verdict
from lagrotor.paper.premises import ONE_KILOGRAM_BAR, PAPERS_ROTOR, in_parameters
from lagrotor.report.content import Report, word


@dataclass(frozen=True)
class Headline:
    """One result: what it says in a line, the sentence with its numbers, a formula, ids of where it is shown."""

    title: str
    text: str
    ids: tuple[str, ...]
    formula: sp.Basic | None = None


def balance(report: Report) -> str:
    """How many equations hold and how many fall, and what becomes of those that fall."""
    counts = report.counts
    hold = sum(counts.get(answer, 0) for answer in ("holds", "holds-if", "holds-to-order"))
    fallen = [verdict for verdict in report.verdicts if verdict.verdict == "refuted"]
    corrected = sum(v.correction_verdict in ("holds", "holds-if", "holds-to-order") for v in fallen)
    reaching = sum(bool(v.reaches_result) for v in fallen)
    other = len(report.verdicts) - hold - len(fallen)
    text = f"Of {len(report.verdicts)} equations {hold} hold: {counts.get('holds', 0)} exactly, "
    text += f"{counts.get('holds-if', 0)} under a condition that is named, "
    text += f"{counts.get('holds-to-order', 0)} to the order that is named. "
    whole = 0 < corrected == len(fallen)
    how = ", each with a correction" if whole else f"; for {corrected} of these a correction is given"
    text += f"{len(fallen)} fall{how} that itself holds, "
    text += f"and {reaching} take a result of the paper with them. The other {other} give a name or a measured number."
    return text


def headlines(report: Report) -> list[Headline]:
    """The three results with the strongest evidence, those whose parts are in the report."""
    return [headline for write in (_constant, _trajectories, _force) for headline in write(report)]


def _constant(report: Report) -> Iterator[Headline]:
    verdict, claim = _verdict(report, "5.25"), _measured(report, "C21")
    if verdict and claim:
        closed = next(r.printed for r in verdict.statement.correction if r.printed.free_symbols & {m, K} == {m})
        of_its_bar = ONE_KILOGRAM_BAR.on(PAPERS_ROTOR.on(in_parameters(closed)))
        yield Headline(
            "The fitted constant has a closed form",
            f"The paper finds {_FITTED} by trial and error (5.25). Derived, it is the closed form below: for its bar and "
            f"equal spins {of_its_bar} = {claim['J_over_J_plus_half_m']:.4f}. Exact runs "
            f"have {claim['constant']:.4f} at its spins, {claim['constant_at_half_the_spins']:.4f} at half of them, "
            f"{claim['constant_bar_K_0.1']:.4f} with a bar of a tenth of the inertia, and "
            f"{claim['constant_light_bar']:.4f} with the light bar. The closed form, judged by the same rules: "
            f"{word(verdict.correction_verdict or 'undecided')}.",
            _there(report, "5.25", "C21", "figure 27"),
            sp.Eq(sp.Symbol("c"), closed, evaluate=False),
        )


_FITTED = "0.7125"


def _trajectories(report: Report) -> Iterator[Headline]:
    verdict, claim, figure = _verdict(report, "5.22"), _measured(report, "C16"), _drawn(report, "19")
    if verdict and claim and figure:
        shortest, longest = (100 * (claim[f"corrected_{end}"] - 1) for end in ("shortest", "longest"))
        yield Headline(
            "The corrected trajectories keep the bar at the wrong length; the right ones stand here",
            f"With the paper's correction (5.20) the bar is {shortest:.1f} to {longest:.1f}% too long all the way, and its "
            f"tip up to {1000 * figure['paper, largest distance (m)']:.0f} mm from the exact one at the same phase. The "
            f"series derived here is within {1000 * figure['order_2, largest distance (m)']:.1f} mm at second order and "
            f"{1000 * figure['order_3, largest distance (m)']:.1f} mm at third. Of the printed x (5.22) the second "
            f"harmonic is right and a constant ± r_0² is missing; the correction, judged by the same rules: "
            f"{word(verdict.correction_verdict or 'undecided')}.",
            _there(report, "5.20", "5.22", "C16", "figure 19"),
        )


def _force(report: Report) -> Iterator[Headline]:
    figure, claim = _drawn(report, "t6"), _measured(report, "C18")
    if figure and claim:
        yield Headline(
            "The paper's −11 N along y is the force that cancels the drift",
            f"A shock of 40 N along x alone makes the pair lean about the joint line at "
            f"{figure['exact rate without a force along y (rad/s)']:.3f} rad/s. Momentum about that line is conserved, and "
            f"from it the force along y that cancels the drift follows: "
            f"{figure['cancelling force, second order (N)']:.2f} N in closed form to second order, "
            f"{figure['cancelling force, exact runs (N)']:.2f} N on exact runs. With −11 N the pair turns by "
            f"{claim['turned_about_joint_line_rad']:.2f} rad in 8 s, without it by "
            f"{claim['turned_about_joint_line_without_y_shock_rad']:.2f}.",
            _there(report, "C18", "figure t6"),
        )


def _verdict(report: Report, identifier: str) -> Verdict | None:
    return next((v for v in report.verdicts if v.id == identifier), None)


def _measured(report: Report, identifier: str) -> Mapping[str, float]:
    return next((r.measured for r in report.claims if r.test.id == identifier), {})


def _drawn(report: Report, key: str) -> Mapping[str, float]:
    return next((p.measured for p in report.pictures if p.key == key), {})


def _there(report: Report, *ids: str) -> tuple[str, ...]:
    """Those that the report has."""
    known = {v.id for v in report.verdicts} | {r.test.id for r in report.claims}
    known |= {f"figure {picture.key}" for picture in report.pictures}
    return tuple(identifier for identifier in ids if identifier in known)
