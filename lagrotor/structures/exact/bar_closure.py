"""Checks that the bars of a structure can close and are independent, and the initial state of a run."""

import numpy as np
from numpy.typing import ArrayLike

from lagrotor.errors import ConstraintError, InputError, SingularError
from lagrotor.numerics.arrays import finite_array
from lagrotor.structures.assembly import Assembly
from lagrotor.structures.coefficients import Array
from lagrotor.structures.exact.exact_motion import ExactMotion, exact_motion, off_constraints, pulls, stretches

_DENSE = 400  # the most unknowns for ranks by singular values
_DEPENDENT = 1e-9  # relative to the largest singular value or pivot: smaller ones are zero


def check_closure(s: Assembly) -> None:
    """Raise InputError if the bars leave no degree of freedom, cannot close at their lengths, or are dependent."""
    N, B = len(s.joints), len(s.bars)
    if B >= 2 * N:
        raise InputError(
            f"Structure: {B} bars leave no degree of freedom: {N} axes have {2 * N}, and each bar takes one; remove at least "
            f"{B - 2 * N + 1}"
        )
    motion = exact_motion(s)
    r = motion.c.upright
    if not s.natural:
        try:
            r = close_bars(motion, r)
        except ConstraintError as error:
            raise InputError(f"Structure: the bars cannot close: {error}; check their lengths") from None
    redundant = _dependent_bar(motion, r)
    if redundant is not None:
        i, j, _ = s.bars[redundant]
        raise InputError(
            f"Structure: dependent constraints: bars[{redundant}] = ({i}, {j}) is redundant "
            f"{'when all axes are upright' if s.natural else 'where the bars close'}; remove it"
        )


def close_bars(motion: ExactMotion, r: Array) -> Array:
    """Find axes (N, 3) on the constraints by Newton's steps from the axes r. Raises ConstraintError if the steps diverge."""
    y, area = np.concatenate([r.ravel(), np.zeros(r.size)]), float((motion.c.ell**2).max(initial=0.0))
    unit = np.append(np.ones(len(r)), np.full(len(motion.c.ell), area))
    with np.errstate(all="ignore"):
        for _ in range(50):
            far = np.abs(off_constraints(motion.c, y[: r.size].reshape(r.shape)) / unit).max()
            if far < 1e-15:
                break
            step = motion.project(y) - y
            size = np.abs(step).max()
            y = y + step * min(1.0, 0.5 / size) if size > 0 else y
            if not np.isfinite(size) or size < 1e-16:
                break
    if not far < 1e-11:
        raise ConstraintError(
            f"no axes near the start satisfy the constraints (residual {far:.2g}, for bars in units of ell² = {area:.3g} m²)"
        )
    return y[: r.size].reshape(r.shape)


def _dependent_bar(motion: ExactMotion, r: Array) -> int | None:
    """Return the number of the first bar whose constraint depends on earlier bars; None if all are independent."""
    c = motion.c
    N, B = len(c.R), len(c.i)
    if not B:
        return None
    from scipy.sparse import csr_matrix
    from scipy.sparse.linalg import splu

    ends = np.concatenate([c.i, c.j])
    pull, axes = np.concatenate(pulls(c, r)) / np.tile(c.ell, 2)[:, None], r[ends]
    transverse = pull - (pull * axes).sum(1, keepdims=True) * axes
    columns = 3 * ends[:, None] + [0, 1, 2]
    sparse = csr_matrix(
        (transverse.ravel(), (np.repeat(np.tile(np.arange(B), 2), 3), columns.ravel())), shape=(B, 3 * N)
    )
    if 2 * N <= _DENSE:
        G = sparse.toarray()
        sizes = np.linalg.svd(G, compute_uv=False)
        if sizes[-1] > _DEPENDENT * sizes[0]:
            return None
        return next(k for k in range(B) if np.linalg.matrix_rank(G[: k + 1], tol=_DEPENDENT * sizes[0]) <= k)
    try:
        factors = splu((sparse @ sparse.T).tocsc(), diag_pivot_thresh=0.0)
    except RuntimeError:  # exactly singular
        return B - 1
    pivots = np.abs(factors.U.diagonal())
    small = pivots < _DEPENDENT * pivots.max()
    return int(factors.perm_c.argsort()[np.argmax(small)]) if small.any() else None


def start_state(motion: ExactMotion, tilt: ArrayLike | None, rates: ArrayLike | None) -> Array:
    """Return the initial state y = (r, r'/rate), (6N,), for the arguments `tilt` and `rates` of `Structure.simulate`. The state
    satisfies the constraints and their time derivatives."""
    N = len(motion.c.R)
    x = _vectors("tilt", tilt, N)
    if x.shape[1] == 2:
        height = 1 - (x**2).sum(1)
        if (height < 0).any():
            raise InputError(f"simulate: tilt of rotor {int(np.argmin(height))} exceeds 1, the sine of a right angle")
        r = np.column_stack([x, np.sqrt(height)])
    else:
        r = x / np.linalg.norm(x, axis=1, keepdims=True)
    r = close_bars(motion, r)
    with np.errstate(all="ignore"):
        degenerate = ~np.isfinite(stretches(motion.c, r)[0]).all(1)
    if degenerate.any():
        raise SingularError(
            f"simulate: braces[{int(np.argmax(degenerate))}] starts with both ends at one place, where it has no direction: "
            "start from another tilt"
        )
    v = _vectors("rates", rates, N)
    if v.shape[1] == 2:
        safe = np.where(np.abs(r[:, 2]) > 1e-6, r[:, 2], np.inf)
        v = np.column_stack([v, -(r[:, :2] * v).sum(1) / safe])
    y = np.concatenate([r.ravel(), v.ravel() / motion.c.rate])
    start = np.concatenate([r.ravel(), motion.project(y)[3 * N :]])
    if not np.isfinite(start).all():
        raise SingularError(
            "simulate: the constraints are dependent at this tilt (a bar is in line with its axes): start from another one"
        )
    return start


def _vectors(name: str, values: ArrayLike | None, N: int) -> Array:
    if values is None:
        return np.zeros((N, 2))
    vectors = finite_array(f"simulate: {name}", values)
    if vectors.shape not in ((N, 2), (N, 3)):
        raise InputError(f"simulate: {name} must be an array of shape ({N}, 2) or ({N}, 3), not {vectors.shape}")
    if vectors.size == 3 * N and name == "tilt" and not (np.linalg.norm(vectors, axis=1) > 0).all():
        raise InputError("simulate: tilt contains a vector of length zero, which is no axis: give unit vectors")
    return vectors
