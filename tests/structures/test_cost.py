"""What an evaluation costs grows as the number of rotors: counted in the entries of the band and of the arrays."""

import numpy as np
import pytest

from lagrotor import Link, Structure
from lagrotor.structures import exact_motion
from lagrotor.structures.exact.compiled_motion import eliminate_in_levels
from lagrotor.structures.exact.exact_motion import pulls, saddle

SIZES = (64, 512, 4096)


def chain(n: int, link: Link) -> Structure:
    return Structure([((k + 1) // 2, k // 2) for k in range(n)], [(k, k + 1) for k in range(n - 1)], 10.0, link=link)


def ring(n: int, link: Link) -> Structure:
    turn, radius = 2 * np.pi / n, n / 6
    joints = [(radius * np.cos(k * turn), radius * np.sin(k * turn)) for k in range(n)]
    return Structure(joints, [(k, (k + 1) % n) for k in range(n)], 10.0, link=link)


def shuffled(n: int, link: Link) -> Structure:
    """The chain, its rotors numbered at random."""
    place = np.random.default_rng(1).permutation(n)
    joints = [None] * n
    for k, at in enumerate(place):
        joints[at] = ((k + 1) // 2, k // 2)
    return Structure(joints, [(int(place[k]), int(place[k + 1])) for k in range(n - 1)], 10.0, link=link)


@pytest.mark.parametrize("link", [Link(), Link(1, 0.3, 0.1)])
@pytest.mark.parametrize(("shape", "widest"), [(chain, 5), (shuffled, 5), (ring, 11)])
def test_the_band_is_as_narrow_for_any_number(shape, widest, link) -> None:
    """LU in a band of half width w takes 4 w² operations a row (Golub & Van Loan, § 4.3): linear in the rows if w stays."""
    found = [saddle(shape(n, link)) for n in SIZES]
    assert {each.band for each in found} == {found[0].band} and found[0].band <= widest
    rows = [each.base.size / n for each, n in zip(found, SIZES, strict=True)]
    assert max(rows) / min(rows) < 1.02
    entries = [len(each.places) / n for each, n in zip(found, SIZES, strict=True)]
    assert max(entries) / min(entries) < 1.02


def test_a_grid_is_solved_sparsely_and_to_the_same_numbers() -> None:
    from dataclasses import replace

    L = 16
    bars = [(i, i + 1) for i in range(L * L) if i % L < L - 1] + [(i, i + L) for i in range(L * L - L)]
    s = Structure(
        [(i % L, i // L) for i in range(L * L)], bars, np.where(np.arange(L * L) % 3, 20, -20), link=Link(1, 0.3, 0.1)
    )
    motion = exact_motion(s)
    assert motion.saddle.band > 60 and not motion.saddle.base.size
    draw = np.random.default_rng(2)
    r = motion.c.upright + 0.1 * draw.standard_normal((L * L, 3))
    r /= np.linalg.norm(r, axis=1, keepdims=True)
    v = draw.standard_normal((L * L, 3))
    found = motion.accelerations(0.0, r, v)
    # The same equations, dense: what the solution leaves of them.
    lam = motion.solution(0.0, r, v)[3 * L * L :]
    pull_i, pull_j = pulls(motion.c, r)
    c = motion.c
    left = c.A[:, None] * found - motion.forces(0.0, r, v) + lam[: L * L, None] * r
    np.add.at(left, c.i, c.coupling[:, None] * found[c.j] + lam[L * L :, None] * pull_i)
    np.add.at(left, c.j, c.coupling[:, None] * found[c.i] + lam[L * L :, None] * pull_j)
    assert np.abs(left).max() < 1e-9 * np.abs(found).max()
    still = 0 * r[None]
    assert np.isnan(
        replace(motion.saddle).solve(still, pulls(motion.c, still), np.ones((1, len(bars) + 4 * L * L, 1)))
    ).all()


def test_a_constraint_is_not_eliminated_before_what_it_holds() -> None:
    """A point of mass 2 on a line: its constraint has the fewest neighbours, and no pivot of its own."""
    x = eliminate_in_levels([2.0, 2.0, 0.0], {(0, 1): 0.5, (0, 2): 1.0}, [1.0, 1.0, 0.0], 2)
    assert x == pytest.approx([0, 0.5, 0.75])
    with pytest.raises(ZeroDivisionError):
        eliminate_in_levels([2.0, 2.0, 0.0], {(0, 1): 0.5, (0, 2): 1.0}, [1.0, 1.0, 0.0], 3)
