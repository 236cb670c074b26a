"""One step of an autonomous motion x' = f(x): the Taylor polynomial, its remainder bound, and the derivative of the step.

On a step of length h, with s = t/h, the motion is P + e: P has the first n Taylor terms, e has powers from n on. The Picard
map e ↦ h ∫ f(P + e) ds − P takes the ball |e_i| ≤ ε_i into itself if

    h (|f_{n−1}| / n + remainder(f) / (n + 1)) ≤ ε,

and the motion is its fixed point. The derivative D with respect to the initial state solves the linear equation D' = h J D.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from lagrotor.proofs.balls import (
    ZERO,
    Ball,
    Balls,
    Matrix,
    arb,
    arb_mat,
    arb_poly,
    arb_series,
    balls_data,
    ctx,
    max_of,
    precision,
    upper,
)
from lagrotor.proofs.matrices import identity, matrix_norm
from lagrotor.proofs.tape import Tape
from lagrotor.proofs.truncated_series import Evaluation, RemainderError, TaylorModel, series_values

SLACK = 4  # factor on each remainder bound, so that the checker's bound is smaller
SINGULAR = "a denominator, or a root's or logarithm's argument, in the equations is not proved to be nonzero"
_TRIES = 4  # iterations of the Picard map for a remainder bound


@dataclass(frozen=True)
class Motion:
    """x' = f(x; parameters): the outputs of the tape are the rates of its first arguments.

    The arguments after the `moving` states are constant parameters that vary within intervals. Derivatives with respect to them
    are computed, too.
    """

    tape: Tape
    parameters: tuple[Any, ...] = ()

    @property
    def moving(self) -> int:
        return len(self.tape.outputs)

    @property
    def size(self) -> int:
        """The number of states plus the number of parameters that vary."""
        return len(self.tape.arguments) - len(self.parameters)

    def data(self) -> dict[str, Any]:
        return self.tape.data() | {"parameters": balls_data(self.parameters)}


def taylor(motion: Motion, start: Balls, n: int) -> list[Balls]:
    """Return the first n Taylor coefficients in t of every state."""
    rows = [[x] for x in start[: motion.moving]]
    still = [*start[motion.moving :], *motion.parameters]
    for k in range(n - 1):
        with precision(ctx.prec, k + 1):
            try:
                rates = series_values(motion.tape, [*(arb_series(row, k + 1) for row in rows), *still])
            except (ZeroDivisionError, ValueError):
                raise RemainderError(SINGULAR) from None
            for row, rate in zip(rows, rates, strict=True):
                value = rate[k] if isinstance(rate, arb_series) else rate if k == 0 else ZERO
                row.append(value / (k + 1))
    return rows


def scale_terms(rows: Sequence[Balls], h: Ball, n: int) -> list[Balls]:
    """Return the first n Taylor coefficients in s = t/h, from the coefficients in t."""
    powers = [arb(1)]
    for _ in range(n - 1):
        powers.append(powers[-1] * h)
    return [[c * p for c, p in zip(row, powers, strict=False)] for row in rows]


def bound_remainder(motion: Motion, rows: Sequence[Balls], start: Balls, h: Ball, n: int) -> tuple[Balls, Evaluation]:
    """Return bounds ε of the remainders after n scaled terms, and the evaluation of the tape that proves them.

    The proof is the Picard inclusion.
    """
    still = [*start[motion.moving :], *motion.parameters]
    guess = [upper(row[-1]) + upper(row[-2]) for row in rows]
    least = max_of(guess) * arb(2) ** -20 + arb(2) ** (-2 * ctx.prec)
    for _ in range(_TRIES):
        guess = [g + least for g in guess]
        moving = [TaylorModel(arb_poly(row), g, n) for row, g in zip(rows, guess, strict=True)]
        evaluation = Evaluation(motion.tape, [*moving, *(TaylorModel(arb_poly([c]), ZERO, n) for c in still)])
        bounds = [upper(h * (abs(f.poly[n - 1]) / n + f.remainder / (n + 1))) for f in evaluation.outputs]
        if all(r <= g for r, g in zip(bounds, guess, strict=True)):
            return bounds, evaluation
        guess = [2 * r for r in bounds]
        if not max_of(guess) < 1:
            break
    raise RemainderError("the remainder of the Taylor series is not bounded over the step")


def step_derivative(motion: Motion, evaluation: Evaluation, h: Ball, n: int) -> tuple[Matrix, list[Matrix]]:
    """Enclose the derivative D of the step with respect to states and varying parameters, shape (size, size).

    Return D and n Taylor terms of D in s.
    """
    size = motion.size
    entries: list[Balls] = [[ZERO] * (size * size) for _ in range(n)]
    bound = ZERO
    for i in range(motion.moving):
        row = ZERO
        for j, entry in enumerate(evaluation.gradient(i)[:size]):
            if entry is not None:
                row += entry.remainder
                for k, c in enumerate(entry.poly.coeffs()):
                    entries[k][i * size + j] = c * h
        bound = bound.max(upper(row * h))
    slopes = [arb_mat(size, size, entry) for entry in entries]
    terms = [identity(size)]
    for k in range(n - 1):
        total = slopes[0] * terms[k]
        for i in range(1, k + 1):
            total = total + slopes[i] * terms[k - i]
        terms.append(total * (arb(1) / (k + 1)))
    outer, inner = ([matrix_norm(m) for m in matrices] for matrices in (slopes, terms))
    over = sum((a * b for i, a in enumerate(outer) for j, b in enumerate(inner) if i + j >= n - 1), ZERO)
    whole, size_found = sum(outer, ZERO) + bound, sum(inner, ZERO)
    margin = 1 - whole / (n + 1)
    if not margin > 0:
        raise RemainderError("the variational equations' series does not converge over the step")
    error = SLACK * upper((over / n + bound * size_found / (n + 1)) / margin)
    total = terms[0]
    for matrix in terms[1:]:
        total = total + matrix
    wide = [arb(0, error) if i < motion.moving else ZERO for i in range(size) for _ in range(size)]
    return total + arb_mat(size, size, wide), terms
