"""Theorems that decide parts of the claims. They enclose motions of the exact pair and need python-flint.

Some theorems say whether an expression of the axes passes zero before a time. Others enclose the mean of an expression over a
time span, or the frequency of a periodic orbit. Each is stronger than the part of the claim needs, so that rounding decides
nothing. The peak of the paper's shocks is at 0.2 s, and at 0.5 s for the wider shocks of section 5.3.
"""

from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import Any

import sympy as sp

from lagrotor.mechanics import System, coordinates, t
from lagrotor.pair.lagrangians import axes_pair
from lagrotor.pair.notation import AXES, a, b
from lagrotor.pair.quantities import Spins
from lagrotor.pair.scene import Link, Scene
from lagrotor.paper.claim_tests import Part, PrintedNumber
from lagrotor.paper.rotor_pair.runs import shocked_scene
from lagrotor.paper.theorems import Theorem
from lagrotor.theory.natural_rate import natural_rate

_TOL = 1e-14  # of a step
_X1, _Y1, _Z1, _X2, _Y2, _Z2 = AXES.q
_Q = sp.Rational
Spans = Sequence[tuple[sp.Expr, Any, Any]]


def _crossing(scene: Scene, event: sp.Expr, time: str, says: str = "") -> Theorem:
    """Prove that an expression of the axes passes zero before a time (s), and return the theorem."""
    from lagrotor.proofs import crossing

    return Theorem.of(crossing(scene, event=event, t_end=time, tol=_TOL), says)


def _no_crossing(scene: Scene, event: sp.Expr, until: str, says: str = "") -> Theorem:
    """Prove that an expression of the axes does not pass zero up to a time (s), and return the theorem."""
    from lagrotor.proofs import no_crossing

    return Theorem.of(no_crossing(scene, event=event, t_end=until, tol=_TOL), says)


def _means(system: Any, spans: Spans, says: str = "", start: Any = (None, None)) -> tuple[tuple[Any, ...], Theorem]:
    """Return proved bounds of means, with the theorem; each row of `spans` is (expression, begin, end)."""
    from lagrotor.proofs import means

    proof = means(system, None, start[0], start[1], spans, _TOL)
    return proof.values, Theorem.of(proof, says)


def _less(a: Any, b: Any) -> bool | None:
    """Return whether a < b for two intervals; None if they overlap."""
    return True if a < b else False if a >= b else None


def _all(answers: Iterable[bool | None]) -> bool | None:
    """Return True if all answers are True, False if one is False, and None otherwise."""
    distinct = {*answers}
    return False if False in distinct else None if None in distinct else True


def _decided(sentence: str, answer: bool | None, *theorems: Theorem) -> Iterator[Part]:
    """Yield the part of the claim with its theorems; yield nothing if the answer is None, which means undecided."""
    if answer is not None:
        yield Part(sentence, answer, theorems=theorems)


def _turning(i: int, y: Any = 0, about: Sequence[Any] = ()) -> sp.Expr:
    """Return x y′ − (y − y₀) x′ for axis i, its angular momentum about the point (0, y₀); the sign is the sense of precession.

    `y` is y₀; `about` gives other coordinates and rates in place of those of the pair.
    """
    q, v = about or (AXES.q[3 * i : 3 * i + 2], AXES.v[3 * i : 3 * i + 2])
    return q[0] * v[1] - (q[1] - y) * v[0]


def _about_joint_line(i: int) -> sp.Expr:
    """Return the rate (rad/s) at which axis i turns about the line through the ground joints."""
    (y, z), (y_v, z_v) = AXES.q[3 * i + 1 : 3 * i + 3], AXES.v[3 * i + 1 : 3 * i + 3]
    return (y * z_v - z * y_v) / (y**2 + z**2)


def lasting_displacement(same_sense: str, remains: str, spins: Spins) -> Iterator[Part]:
    """C01: prove that both axes of equal spins precess about a displaced point, by means over the first and the fifth cycle."""
    if spins != (10, 10):
        return
    scene, y = shocked_scene(spins, (50, 0, 0)), _Q("0.0886")  # by equation (7)
    first, fifth = ("0.4", "1.4954"), ("4.7816", "5.877")
    both, theorem = _means(scene, [(_turning(i, y), *first) for i in (0, 1)], "A cycle takes 1.095 s.")
    yield from _decided(same_sense, _all(_less(0, x) for x in both), theorem)
    spans = [(e, *span) for span in (first, fifth) for e in (_Y1, _Y2)] + [((_Y1 - y) ** 2, *fifth)]
    averages, theorem = _means(scene, spans, "A cycle takes 1.095 s; the last mean is that of the squared swing of y₁.")
    pairs = tuple(zip(averages[:2], averages[2:4], strict=True))
    lasts = (*(_less(abs(n / m - 1), 0.01) for m, n in pairs), *(_less(averages[4] / 50, n * n) for _, n in pairs))
    yield from _decided(remains, _all(lasts), theorem)


def not_without_spin(sentence: str, bar: Link) -> Iterator[Part]:
    """C02: prove that x passes 1/2 within 2.4 s of a shock along the bar without spins, but not 1/5 with opposite spins."""
    free = _crossing(shocked_scene((0, 0), (50, 0, 0), bar), _X1 - _Q(1, 2), "2.6")
    opposite = _no_crossing(shocked_scene((10, -10), (50, 0, 0), bar), _X1**2 - _Q(1, 25), "2.6")
    yield Part(sentence, False, theorems=(free, opposite))


def energies(initial: str, final: str, spins: Spins, printed: dict[str, PrintedNumber]) -> Iterator[Part]:
    """C08: enclose the energy before and after the shock, and compare it with the printed numbers."""
    scene = shocked_scene(spins, (50, 0, 0))
    inertias = {s: _Q(str(x)) for s, x in zip((a, b), scene.inertias, strict=True)}
    energy = axes_pair().L.xreplace(inertias) + sum(_Q(str(w)) ** 2 for w in spins) * _Q(str(scene.rotor.I3)) / 2
    spans = [(sp.Eq(sp.Symbol("E"), energy), *span) for span in ((0, "0.05"), ("0.4", "0.5"))]
    averages, theorem = _means(scene, spans, "E is the energy in J.")
    for sentence, mean, number in zip((initial, final), averages, printed.values(), strict=True):
        yield from _decided(sentence, _less(abs(mean - number), number.half_unit), theorem)


def topples(sentence: str, spins: Spins) -> Iterator[Part]:
    """C10: prove that axes without spins reach 75° after a shock along the bar, and 90° after a shock across it."""
    if spins == (0, 0):
        shock_x = _crossing(shocked_scene(spins, (50, 0, 0)), _Z1 - _Q(1, 4), "2.9", "z₁ = 1/4 is 75.5° from upright.")
        shock_y = _crossing(shocked_scene(spins, (0, 50, 0)), _Z1, "2.5", "z₁ = 0 is 90° from upright.")
        yield Part(sentence, True, theorems=(shock_x, shock_y))


def topples_slowly(
    stable: str, topples_yz: str, slowly: str, spins: Spins, visible: float, slow: float
) -> Iterator[Part]:
    """C11: decide whether opposite spins topple slowly and stay stable in x.

    Enclose the rate at which the pair turns about the joint line after two shocks. It must exceed `visible` rad in 8 s and be
    below `slow` rad per period. Prove also that |x| passes 1/2 after a shock along −y.
    """
    if spins != (10, -10):
        return
    theorems, rates, turn = list[Theorem](), list[Any](), 2 * pi / natural_rate(shocked_scene(spins, (50, 0, 0)))
    for force in ((50, 0, 0), (0, 50, 0)):
        spans = [(_about_joint_line(i), "0.4", "8.2") for i in (0, 1)]
        averages, theorem = _means(shocked_scene(spins, force), spans)
        theorems.append(theorem)
        rates += map(abs, averages)
    yield from _decided(topples_yz, _all(_less(visible, x * 8) for x in rates), *theorems)
    yield from _decided(slowly, _all(_less(x * turn, slow) for x in rates), *theorems)
    fall = _crossing(shocked_scene(spins, (0, -50, 0)), _X1**2 - _Q(1, 4), "9.5", "|x₁| = 1/2 is 30° from upright.")
    yield Part(stable, False, theorems=(fall,))


def axes_part(sentence: str, bar: Link) -> Iterator[Part]:
    """C12: prove that the angle between the axes of opposite spins passes 0.1 rad within 1 s from the start."""
    event = _X1 * _X2 + _Y1 * _Y2 + _Z1 * _Z2 - sp.cos(_Q(1, 10))
    says = "Its zero is an angle of 0.1 rad between the axes."
    yield Part(sentence, True, theorems=(_crossing(shocked_scene((10, -10), (50, 0, 0), bar), event, "1", says),))


def mean_displacement(sentence: str) -> Iterator[Part]:
    """C13: enclose the mean x of both axes of opposite spins over four cycles after a shock across the bar."""
    spans = [(x, "0.4", "6.4") for x in (_X1, _X2)]
    averages, theorem = _means(shocked_scene((10, -10), (0, 50, 0)), spans, "Each mean is over four cycles.")
    yield from _decided(sentence, _all(_less(-0.02, x) for x in averages), theorem)


def single_rate(sentence: str, spins: Spins, printed: PrintedNumber) -> Iterator[Part]:
    """C20: enclose the mean rate of one rotor over five cycles. The rotor is a point on a sphere with the force G r × r'."""
    if spins != (20, 20):
        return
    c = coordinates("x y z")
    r, v, scene = sp.Matrix(c.q), sp.Matrix(c.v), Scene(spins, link=None)
    push = 40 * sp.exp(-(((t - _Q(1, 2)) / _Q(1, 20)) ** 2))
    force = _Q(str(scene.momenta[0])) * r.cross(v) + sp.Matrix([push, 0, 0])
    rotor = System(c, _Q(str(scene.rotor.J)) / 2 * v.dot(v), ((r.dot(r) - 1) / 2,), forces=tuple(force))
    x, y = c.q[0], c.q[1] - _Q("0.175")
    rate = _turning(0, _Q("0.175"), (c.q, c.v)) / (x**2 + y**2)
    averages, theorem = _means(
        rotor, [(rate, 1, 3)], "The mean is the rate in rad/s about the displaced position.", ([0, 0, 1], [0, 0, 0])
    )
    yield from _decided(sentence, _less(abs(averages[0] - printed), printed.half_unit), theorem)


def coupled_rates(sentence: str, spins: Spins, bar: Link, printed: PrintedNumber) -> Iterator[Part]:
    """C21: enclose the mean rate of equal spins over four cycles, after a small shock and after the paper's shock."""
    if spins != (20, 20):
        return
    theorems, agree = list[Theorem](), list[bool | None]()
    for force, y in ((_Q("0.4"), _Q("0.000886")), (_Q(40), _Q("0.0886"))):
        x1, y1 = _X1, _Y1 - y
        spans = [(_turning(0, y) / (x1**2 + y1**2), "0.9", "3.1")]
        averages, theorem = _means(
            shocked_scene(spins, (float(force), 0, 0), bar, 1 / 20), spans, "The mean is the rate in rad/s."
        )
        theorems.append(theorem)
        agree.append(_less(abs(averages[0] - printed), printed.half_unit))
    yield from _decided(sentence, _all(agree), *theorems)


def not_followed(sentence: str, spins: Spins, bars: Sequence[Link]) -> Iterator[Part]:
    """C22: prove for both bars that x is positive at the second trough of a sine of 5.7 rad/s that starts at the shock."""
    if spins != (10, -10):
        return
    says = "sin 5.7 (t − 0.5) has a trough at t = 2.429 s."
    averages = [_means(shocked_scene(spins, (40, 0, 0), bar, 1 / 20), [(_X1, "2.38", "2.48")], says) for bar in bars]
    yield from _decided(
        sentence, _all(_less(values[0], 0) for values, _ in averages), *(theorem for _, theorem in averages)
    )


def rate_changes(sentence: str, scene: Scene, r0: float, unchanged: float) -> Iterator[Part]:
    """C17: decide whether the orbit's frequency differs from G/(J cos θ) by less than `unchanged` r0², in relative terms."""
    from lagrotor.proofs import precession

    if scene.spins[0] != -scene.spins[1]:
        return
    orbit = precession(scene, r0)
    constant = abs(scene.momenta[0]) / (scene.rotor.J * (1 - r0**2) ** 0.5)
    change = (abs(orbit.frequency) / constant - 1) / r0**2
    words = f"At constant inclination the frequency would be {constant:.4f} rad/s."
    yield from _decided(sentence, _less(abs(change), unchanged), Theorem.of(orbit, words))


def over_cosine(sentence: str, scene: Scene, r0: float) -> Iterator[Part]:
    """C23: prove that the paired precession is slower than the natural rate, whereas the claimed rate is faster."""
    from lagrotor.proofs import precession

    if scene.spins[0] != -scene.spins[1]:
        return
    orbit, natural = precession(scene, r0), natural_rate(scene)
    words = f"The natural rate is {natural:g} rad/s; divided by the cosine of an inclination it is larger."
    yield from _decided(sentence, _less(natural, abs(orbit.frequency)), Theorem.of(orbit, words))
