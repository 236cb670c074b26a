"""The check of a periodic orbit: Krawczyk test, reversals, period and Floquet multipliers of a certificate."""

from typing import Any

from flint import arb, arb_mat, arb_poly

from lagrotor.proofs.checker.bounded_series import total
from lagrotor.proofs.checker.certified_sets import (
    VerifiedSteps,
    balls,
    column,
    krawczyk,
    matrix,
    middle_inverse,
    read_ball,
    unit,
)
from lagrotor.proofs.checker.reversals import check_reversal
from lagrotor.proofs.checker.tapes import ZERO, demand, demand_pace, is_place, rational_of

Ball = Any
_FREE = [4, 5, 6]  # places of chi', alpha' and the pace of the pair


def check_orbit(certificate: Any) -> None:
    """Verify the Krawczyk test at the end of the steps, the reversals, the period and the multipliers."""
    carried = VerifiedSteps(certificate)
    free, conditions = certificate["free"], certificate["conditions"]
    first, last = certificate["reversals"]
    demand(bool(first) == bool(last), "only one end has a reversal")
    size, moving = carried.flow.size, carried.flow.moving
    fits = size == moving + 1 and len(free) == len(conditions) == len({*free}) and moving in free
    demand(fits and all(is_place(i, size) for i in (*free, *conditions)), "the conditions do not fit the unknowns")
    demand_pace(carried.flow.tape)
    still = all(x.is_zero() for i, x in enumerate(carried.w) if i not in free)
    demand(still, "a fixed state is an interval")
    demand(carried.time.contains(1) and carried.time.rad() < arb(2) ** -40, "the steps do not take one unit of s")
    check_conditions(carried, first, last, free, conditions)
    A, D = matrix(certificate["A"]), carried.derivative
    returns = 0 if first else 1
    miss = column([carried.point[i] - returns * carried.middle[i] for i in conditions])
    slope = arb_mat([[D[i, j] - returns * int(i == j) for j in free] for i in conditions])
    start = list(carried.middle)
    for i, x in zip(free, krawczyk(miss, slope, A, [carried.w[i] for i in free]), strict=True):
        start[i] += x
    turns = 1 if not first else 2 if first == last else 4
    claim = certificate["claim"]
    states = balls(claim["start"])
    fits = len(states) == moving and all(y.contains(x) for x, y in zip(start, states, strict=False))
    demand(fits, "the claimed start does not contain the start of the orbit")
    period = turns * start[moving]
    fits = period > 0 and read_ball(claim["period"]).contains(period)
    demand(fits, "the claimed period does not contain the period of the orbit")
    check_kind(certificate, carried, first, last)
    if "r0" in claim:
        check_amplitude(certificate, claim["r0"])


def check_amplitude(certificate: Any, claimed: Any) -> None:
    """Verify that the orbit is a paired precession of a scene, and that its start has the claimed amplitude."""
    of_pair = certificate["reversals"] == [[1, -1, -1, -1, 1, 1], [-1, 1, -1, 1, -1, 1]]
    demand("scene" in (certificate["about"] or {}) and of_pair, "the orbit is not a paired precession of a scene")
    demand(certificate["ones"] == 4, "a precession has four multipliers equal to 1")
    demand(certificate["free"] == _FREE, "the amplitude is not fixed")
    U = read_ball(certificate["start"]["middle"][0])
    fits = claimed == [claimed[0]] * 2 and U.contains(rational_of(claimed[0]).atanh())
    demand(fits, "the claimed amplitude is not the amplitude of the start")


def check_conditions(carried: VerifiedSteps, first: Any, last: Any, free: Any, conditions: Any) -> None:
    """Verify that the free states at the start and the conditions at the end define the fixed sets of two reversals."""
    moving = carried.flow.moving
    if not first:
        demand(sorted(conditions) == list(range(moving)), "the conditions do not close the orbit")
        return
    ends = [i for i, s in enumerate(last) if s < 0]
    demand(sorted(conditions) == ends, "the conditions are not those of the second reversal")
    for i, s in enumerate(first):
        fixed = carried.middle[i].is_zero() and carried.w[i].is_zero()
        demand(s > 0 or (fixed and i not in free), "the start is not in the fixed set of the reversal")
    for signs in (first, last):
        check_reversal(carried.flow.tape, signs)


def check_kind(certificate: Any, carried: VerifiedSteps, first: Any, last: Any) -> None:
    """Verify the stability: the sum μ + 1/μ of one pair is compared with ±2, or all multipliers with the unit circle."""
    claim, moving = certificate["claim"], carried.flow.moving
    demand(is_place(certificate["ones"], moving + 1), "the number of multipliers equal to 1 is invalid")
    demand(
        claim["kind"] in ("undecided", "elliptic", "hyperbolic", "attracting", "parabolic"),
        "the claimed kind is unknown",
    )
    if claim["kind"] == "undecided":
        return
    whole = carried.derivative
    D = arb_mat([[whole[i, j] for j in range(moving)] for i in range(moving)])
    ones = certificate["ones"]
    if not first:
        values = D.eig()
        unity = [z for z in values if z.contains(1)]
        others = [abs(z) for z in values if not z.contains(1)]
        fine = all(x < 1 for x in others) if claim["kind"] == "attracting" else all(x < 1 or x > 1 for x in others)
        fine = fine and len(unity) == 1 and claim["kind"] in ("attracting", "hyperbolic")
        demand(fine, "the multipliers are not proved to be off the unit circle")
        return
    pair = pair_sum(D, first, last, ones)
    if claim["kind"] == "parabolic":
        demand(moving == ones, "a pair of multipliers can differ from 1")
        return
    demand(moving - ones == 2, "more than one pair of multipliers can differ from 1")
    demand(
        read_ball(claim["pair_sum"]).contains(pair),
        "the claimed sum of two multipliers does not contain the verified one",
    )
    demand(claim["kind"] == kind_of(pair), f"the orbit is not proved to be {claim['kind']}")


def kind_of(pair: Ball) -> str:
    return "elliptic" if abs(pair) < 2 else "hyperbolic" if abs(pair) > 2 else "undecided"


def pair_sum(D: Any, first: Any, last: Any, ones: int) -> Ball:
    """Return μ + 1/μ of the one pair of multipliers that can differ from 1, from the derivative D between two reversals."""
    moving = D.nrows()
    X = middle_inverse(D)
    R = unit(moving) - D * X
    size = max((total(row) for row in R.tolist()), key=lambda x: float(x.upper()))
    demand(size < 1, "the derivative is not proved to be invertible")
    bound = (size**2 / (1 - size)).upper()
    inverse = X * (unit(moving) + R + arb_mat(moving, moving, [arb(0, bound)] * moving**2))
    places = range(moving)
    reflect = [arb_mat([[s[i] if i == j else 0 for j in places] for i in places]) for s in (first, last)]
    half = reflect[0] * inverse * reflect[1] * D
    M = half if first == last else half * half
    pair = sum((M[i, i] for i in range(moving)), ZERO) - ones
    factor = arb_poly([1, -pair, 1]) if moving > ones else arb_poly([1])
    difference = M.charpoly() - arb_poly([-1, 1]) ** ones * factor
    demand(
        all(x.contains(0) for x in difference.coeffs()),
        "the multipliers are not the stated number of ones and one pair",
    )
    return pair
