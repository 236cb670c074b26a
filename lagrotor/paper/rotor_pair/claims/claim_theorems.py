"""Parts of the claims that are theorems: motions of the exact pair, enclosed. They need python-flint.

Each theorem says more than its part needs, so that rounding decides nothing: that an expression of the axes passes zero before a
stated time, or does not, its mean over a span of time, or the frequency of a periodic orbit. The peak of the paper's shocks is at
0.2 s, of the wider ones of section 5.3 at 0.5 s.
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


def _crossing(scene: Scene, event: sp.Expr, before: str, says: str = "") -> Theorem:
    """That an expression of the axes passes zero before a time."""
    from lagrotor.proofs import crossing

    return Theorem.of(crossing(scene, event=event, t_end=before, tol=_TOL), says)


def _no_crossing(scene: Scene, event: sp.Expr, until: str, says: str = "") -> Theorem:
    """That it does not up to a time."""
    from lagrotor.proofs import no_crossing

    return Theorem.of(no_crossing(scene, event=event, t_end=until, tol=_TOL), says)


def _means(system: Any, spans: Spans, says: str = "", start: Any = (None, None)) -> tuple[tuple[Any, ...], Theorem]:
    """Means over spans of time, and the theorem."""
    from lagrotor.proofs import means

    found = means(system, None, start[0], start[1], spans, _TOL)
    return found.values, Theorem.of(found, says)


def _less(a: Any, b: Any) -> bool | None:
    """a < b of balls; None where they overlap."""
    return True if a < b else False if a >= b else None


def _all(answers: Iterable[bool | None]) -> bool | None:
    """Return whether all hold; None where that is open."""
    each = {*answers}
    return False if False in each else None if None in each else True


def _decided(part: str, answer: bool | None, *theorems: Theorem) -> Iterator[Part]:
    """The part with its theorems; nothing where the enclosures leave it open."""
    if answer is not None:
        yield Part(part, answer, theorems=theorems)


def _turning(i: int, y: Any = 0, about: Sequence[Any] = ()) -> sp.Expr:
    """(x, y) × its rate, of an axis about the point (0, y): its sign is the sense of the precession."""
    q, v = about or (AXES.q[3 * i : 3 * i + 2], AXES.v[3 * i : 3 * i + 2])
    return q[0] * v[1] - (q[1] - y) * v[0]


def _about_joint_line(i: int) -> sp.Expr:
    """The rate (rad/s) at which an axis turns about the line through the ground joints."""
    (y, z), (y_v, z_v) = AXES.q[3 * i + 1 : 3 * i + 3], AXES.v[3 * i + 1 : 3 * i + 3]
    return (y * z_v - z * y_v) / (y**2 + z**2)


def lasting_displacement(same_sense: str, remains: str, spins: Spins) -> Iterator[Part]:
    """C01: both axes of equal spins turn about a displaced point, their mean in the first cycle and in the fifth."""
    if spins != (10, 10):
        return
    scene, y = shocked_scene(spins, (50, 0, 0)), _Q("0.0886")  # by equation (7)
    first, fifth = ("0.4", "1.4954"), ("4.7816", "5.877")
    both, theorem = _means(scene, [(_turning(i, y), *first) for i in (0, 1)], "A cycle takes 1.095 s.")
    yield from _decided(same_sense, _all(_less(0, x) for x in both), theorem)
    spans = [(e, *span) for span in (first, fifth) for e in (_Y1, _Y2)] + [((_Y1 - y) ** 2, *fifth)]
    found, theorem = _means(scene, spans, "A cycle takes 1.095 s; the last mean is that of the swing.")
    pairs = tuple(zip(found[:2], found[2:4], strict=True))
    lasts = (*(_less(abs(n / m - 1), 0.01) for m, n in pairs), *(_less(found[4] / 50, n * n) for _, n in pairs))
    yield from _decided(remains, _all(lasts), theorem)


def not_without_spin(part: str, bar: Link) -> Iterator[Part]:
    """C02: within 2.4 s of a shock along the bar x is above 1/2 without spins, and below 1/5 with opposite ones."""
    free = _crossing(shocked_scene((0, 0), (50, 0, 0), bar), _X1 - _Q(1, 2), "2.6")
    held = _no_crossing(shocked_scene((10, -10), (50, 0, 0), bar), _X1**2 - _Q(1, 25), "2.6")
    yield Part(part, False, theorems=(free, held))


def energies(before: str, after: str, spins: Spins, printed: dict[str, PrintedNumber]) -> Iterator[Part]:
    """C08: the energy before and after the shock."""
    scene = shocked_scene(spins, (50, 0, 0))
    put = {s: _Q(str(x)) for s, x in zip((a, b), scene.inertias, strict=True)}
    energy = axes_pair().L.xreplace(put) + sum(_Q(str(w)) ** 2 for w in spins) * _Q(str(scene.rotor.I3)) / 2
    spans = [(sp.Eq(sp.Symbol("E"), energy), *span) for span in ((0, "0.05"), ("0.4", "0.5"))]
    found, theorem = _means(scene, spans, "E is the energy in J.")
    for part, mean, number in zip((before, after), found, printed.values(), strict=True):
        yield from _decided(part, _less(abs(mean - number), number.half_unit), theorem)


def topples(part: str, spins: Spins) -> Iterator[Part]:
    """C10: without spins the axes fall to 75° after a shock along the bar, and to 90° after one across it."""
    if spins == (0, 0):
        along = _crossing(shocked_scene(spins, (50, 0, 0)), _Z1 - _Q(1, 4), "2.9", "z₁ = 1/4 is 75.5° from upright.")
        across = _crossing(shocked_scene(spins, (0, 50, 0)), _Z1, "2.5", "z₁ = 0 is 90° from upright.")
        yield Part(part, True, theorems=(along, across))


def topples_slowly(stable: str, topples_yz: str, slowly: str, spins: Spins, seen: float, slow: float) -> Iterator[Part]:
    """C11: after the shocks of figures 12 and 13 the pair turns about the joint line, slowly; after one along −y x grows.

    seen: rad in the paper's 8 s, at least. slow: rad in a period of the natural rate, at most.
    """
    if spins != (10, -10):
        return
    theorems, rates, turn = list[Theorem](), list[Any](), 2 * pi / natural_rate(shocked_scene(spins, (50, 0, 0)))
    for force in ((50, 0, 0), (0, 50, 0)):
        spans = [(_about_joint_line(i), "0.4", "8.2") for i in (0, 1)]
        found, theorem = _means(shocked_scene(spins, force), spans)
        theorems.append(theorem)
        rates += map(abs, found)
    yield from _decided(topples_yz, _all(_less(seen, x * 8) for x in rates), *theorems)
    yield from _decided(slowly, _all(_less(x * turn, slow) for x in rates), *theorems)
    fall = _crossing(shocked_scene(spins, (0, -50, 0)), _X1**2 - _Q(1, 4), "9.5", "|x₁| = 1/2 is 30° from upright.")
    yield Part(stable, False, theorems=(fall,))


def axes_part(part: str, bar: Link) -> Iterator[Part]:
    """C12: the angle between the axes of opposite spins passes 0.1 rad within 1 s of the start."""
    event = _X1 * _X2 + _Y1 * _Y2 + _Z1 * _Z2 - sp.cos(_Q(1, 10))
    says = "Its zero is an angle of 0.1 rad between the axes."
    yield Part(part, True, theorems=(_crossing(shocked_scene((10, -10), (50, 0, 0), bar), event, "1", says),))


def mean_displacement(part: str) -> Iterator[Part]:
    """C13: after the shock across the bar both axes of opposite spins have a mean x, over four cycles of the natural rate."""
    spans = [(x, "0.4", "6.4") for x in (_X1, _X2)]
    found, theorem = _means(shocked_scene((10, -10), (0, 50, 0)), spans, "This is over four cycles.")
    yield from _decided(part, _all(_less(-0.02, x) for x in found), theorem)


def single_rate(part: str, spins: Spins, printed: PrintedNumber) -> Iterator[Part]:
    """C20: the mean rate of one rotor, a point on a sphere with the force G r × r', over five cycles after the shock."""
    if spins != (20, 20):
        return
    c = coordinates("x y z")
    r, v, scene = sp.Matrix(c.q), sp.Matrix(c.v), Scene(spins, link=None)
    push = 40 * sp.exp(-(((t - _Q(1, 2)) / _Q(1, 20)) ** 2))
    force = _Q(str(scene.momenta[0])) * r.cross(v) + sp.Matrix([push, 0, 0])
    rotor = System(c, _Q(str(scene.rotor.J)) / 2 * v.dot(v), ((r.dot(r) - 1) / 2,), forces=tuple(force))
    x, y = c.q[0], c.q[1] - _Q("0.175")
    rate = _turning(0, _Q("0.175"), (c.q, c.v)) / (x**2 + y**2)
    found, theorem = _means(
        rotor, [(rate, 1, 3)], "This is the rate about its displaced position, rad/s.", ([0, 0, 1], [0, 0, 0])
    )
    yield from _decided(part, _less(abs(found[0] - printed), printed.half_unit), theorem)


def coupled_rates(part: str, spins: Spins, bar: Link, printed: PrintedNumber) -> Iterator[Part]:
    """C21: the mean rate of equal spins after a small shock and after the paper's, over four cycles."""
    if spins != (20, 20):
        return
    theorems, agree = list[Theorem](), list[bool | None]()
    for force, y in ((_Q("0.4"), _Q("0.000886")), (_Q(40), _Q("0.0886"))):
        x1, y1 = _X1, _Y1 - y
        spans = [(_turning(0, y) / (x1**2 + y1**2), "0.9", "3.1")]
        found, theorem = _means(
            shocked_scene(spins, (float(force), 0, 0), bar, 1 / 20),
            spans,
            "This is the rate in rad/s.",
        )
        theorems.append(theorem)
        agree.append(_less(abs(found[0] - printed), printed.half_unit))
    yield from _decided(part, _all(agree), *theorems)


def not_followed(part: str, spins: Spins, bars: Sequence[Link]) -> Iterator[Part]:
    """C22: where a wave of 5.7 rad/s that begins with the shock has its second trough, x is positive, with either listed bar."""
    if spins != (10, -10):
        return
    says = "sin 5.7 (t − 0.5) has a trough at t = 2.429 s."
    found = [_means(shocked_scene(spins, (40, 0, 0), bar, 1 / 20), [(_X1, "2.38", "2.48")], says) for bar in bars]
    yield from _decided(part, _all(_less(values[0], 0) for values, _ in found), *(theorem for _, theorem in found))


def rate_changes(part: str, scene: Scene, r0: float, unchanged: float) -> Iterator[Part]:
    """C17: the orbit's frequency is not G/(J cos θ), the one of constant inclination, by more than `unchanged` r0²."""
    from lagrotor.proofs import precession

    if scene.spins[0] != -scene.spins[1]:
        return
    orbit = precession(scene, r0)
    constant = abs(scene.momenta[0]) / (scene.rotor.J * (1 - r0**2) ** 0.5)
    change = (abs(orbit.frequency) / constant - 1) / r0**2
    words = f"At constant inclination: {constant:.4f} rad/s."
    yield from _decided(part, _less(abs(change), unchanged), Theorem.of(orbit, words))


def over_cosine(part: str, scene: Scene, r0: float) -> Iterator[Part]:
    """C23: the paired precession is slower than the natural rate, which over a cosine is faster."""
    from lagrotor.proofs import precession

    if scene.spins[0] != -scene.spins[1]:
        return
    orbit, natural = precession(scene, r0), natural_rate(scene)
    words = f"The natural rate is {natural:g} rad/s; over the cosine of an inclination it is more."
    yield from _decided(part, _less(natural, abs(orbit.frequency)), Theorem.of(orbit, words))
