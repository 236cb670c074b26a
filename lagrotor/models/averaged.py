"""Opposite spins averaged over their swing: small motion at any lean, with any bar, for ten thousand turns at once.

Without weight a pair at rest remains at rest in any position. About such an equilibrium, at the lean of the swing's centre, the
Hamiltonian in the coordinates q of `minimal`,

    H = (p − g)·M⁻¹ (p − g)/2,    M(q) and g(q) of L = q'·M q'/2 + g·q',

has one oscillation, the swing. The rotation about the joint line and the displacement of the swing's centre have the rate zero.
The normal form through an order N is H averaged over the swing. Its action and the momentum about the joint line are constant,
and some hundred steps follow the slow centre over any time. The forms through N − 2 and N − 4 are truncations of it. The error
is estimated from the rate at which the differences between these three motions decrease. Spins that are not opposite let the
axes twist apart freely, and no motion stays small.
"""

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lagrotor.errors import DomainError, SingularError
from lagrotor.mechanics.canonical.polynomials import Polynomial, inverse_matrix, total, variable
from lagrotor.models.minimal import MODEL, RATIOS
from lagrotor.models.model import PACE, Array, ClosedMotion, integrate_model, natural_units, without_idle_shock
from lagrotor.numerics.error_estimate import UNKNOWN
from lagrotor.numerics.segment import StopError
from lagrotor.numerics.solver_constants import LOST, Calibrated
from lagrotor.numerics.source_cache import generated
from lagrotor.pair.scene import Scene

if TYPE_CHECKING:
    from lagrotor.mechanics.canonical.normal_forms import NormalForm

_ORDERS = (6, 8)
FALLING = Calibrated(
    20.0,
    "error of a normal form over its difference from the one two orders lower, in units of the ratio of the last two differences",
    "74 random pairs over 10 to 300 turns: at most 6.2",
    "test_averaged.py::test_the_error_is_bounded",
)
# An order is not derived, which takes longer than all else, where its error is known to exceed the tolerance.
LEAST_ERROR = Calibrated(
    (0.2, 0.01),
    "least errors of the forms of order 6 and 8, per turn, in units of the third and the fourth power of the squared size of the "
    "swing",
    "34 random pairs over 350 to 3,000 turns: at least 0.24 and 0.017",
    "test_averaged.py::test_no_form_is_derived_that_cannot_keep_the_tolerance",
)
_SLOWEST = 0.3  # the largest ratio at which the orders converge
_ROUNDED = 3e-14  # rad: rounding per rad of the swing
_PULSE = 1e-12, 1e-11  # local errors of the two integrations through a pulse
_MOST = 20_000  # evaluations through a pulse
_TRIES = 60  # iterations for the normal coordinates of a start
_AT_ONCE = 256  # times per batch


class Forms(NamedTuple):
    """A normal form of the averaged motion about the equilibrium q = (lean, 0, 0), p = momentum. `maps` are the six coordinates
    that diagonalise the quadratic part H₂, as polynomials in the normal coordinates. `turning` is the index of the azimuth
    among these coordinates."""

    form: "NormalForm"
    maps: tuple[Polynomial, ...]
    turning: int
    lean: float
    momentum: Array


class _Sums(NamedTuple):
    """k polynomials in d variables with the same m monomials: exponents (m, d), and coefficients (m, k), one column for each."""

    exponents: Any
    coefficients: Any

    def at(self, points: Any) -> Any:
        """Return the values (n, k) of the k polynomials at n points (n, d)."""
        powers = points[..., None] ** np.arange(self.exponents.max(initial=0) + 1)
        terms = np.ones((len(points), len(self.exponents)), complex)
        for j, power in enumerate(self.exponents.T):
            terms *= powers[:, j, power]
        return terms @ self.coefficients


def _sums(polynomials: tuple[Polynomial, ...]) -> _Sums:
    every, at = np.unique(np.concatenate([f.exponents for f in polynomials]), axis=0, return_inverse=True)
    coefficients, begun = np.zeros((len(every), len(polynomials)), complex), 0
    for k, f in enumerate(polynomials):
        coefficients[at.ravel()[begun : begun + len(f.exponents)], k] = f.coefficients
        begun += len(f.exponents)
    return _Sums(every, coefficients)


@lru_cache(maxsize=3)
def _kinetic(ratio: Any) -> tuple[Any, Any]:
    """Return M (3, 3) and g (3,) of the module as symbolic expressions, for a kind of length ratio of bar and axes."""
    import sympy as sp

    from lagrotor.algebra import hessian
    from lagrotor.mechanics import System
    from lagrotor.mechanics.lagrangian import gradient
    from lagrotor.pair.lagrangians import bar_curve, mercator_lagrangian, minimal_embedding
    from lagrotor.pair.notation import MERCATOR, MINIMAL

    curve = bar_curve(ratio)
    L = (
        System(MERCATOR, mercator_lagrangian())
        .in_coordinates(MINIMAL, minimal_embedding(curve.twist, curve.latitude))
        .L
    )
    return hessian(L, MINIMAL.v), gradient(L, MINIMAL.v).subs(dict.fromkeys(MINIMAL.v, sp.S.Zero))


@generated((ratio,) for ratio in RATIOS)
def _momenta(ratio: Any) -> str:
    """Return the source of a function on arrays, (U, chi; a, b, k, G_1, G_2) → the nine entries of M, then three of g."""
    from lagrotor.numerics.codegen import Program
    from lagrotor.numerics.printers import program_source
    from lagrotor.pair.notation import G_1, G_2, MINIMAL, a, b, k

    M, g = _kinetic(ratio)
    return program_source(Program((*MINIMAL.q[:2], a, b, k, G_1, G_2), (), (*M, *g)), "numpy")


def _momenta_at(scene: Scene, q: Array) -> tuple[Array, Array]:
    """Return M (n, 3, 3) and g (n, 3) of the module at n coordinates of `minimal`, (n, 3)."""
    (_, ratio, _), _ = MODEL.kind(scene, False)
    values = _momenta(ratio)(q[:, 0], q[:, 1], *scene.inertias, scene.k, *scene.momenta)
    columns = np.stack([np.broadcast_to(value, len(q)) for value in values], axis=1)
    return columns[:, :9].reshape(-1, 3, 3), columns[:, 9:]


@lru_cache(maxsize=16)
def _forms(ratio: Any, a: float, b: float, k: float, G_1: float, G_2: float, lean: float, order: int) -> Forms:
    import sympy as sp

    from lagrotor.mechanics.canonical.normal_forms import normal_form_of_series
    from lagrotor.mechanics.canonical.taylor_series import LocalSeries
    from lagrotor.pair import notation

    numbers = dict(zip((getattr(notation, s) for s in ("a", "b", "k", "G_1", "G_2")), (a, b, k, G_1, G_2), strict=True))
    at = {s: sp.Float(v, 17) for s, v in numbers.items()}
    q = notation.MINIMAL.q
    equilibrium = dict(zip(q, (sp.Float(lean, 17), sp.S.Zero, sp.S.Zero), strict=True))
    displacement = {s: variable(i, 6, kind=float) for i, s in enumerate(q)}
    M, g = (e.xreplace(at) for e in _kinetic(ratio))
    mass, vector = (
        LocalSeries(equilibrium, displacement, through, lambda e: float(sp.N(e, 20)))
        for through in (order - 2, order - 1)
    )
    inverse = inverse_matrix([[mass.of(M[i, j]) for j in range(3)] for i in range(3)], order - 2)
    gyroscopic = [vector.of(e) for e in g]
    free = [variable(3 + i, 6, kind=float) - (f - f.part(0)) for i, f in enumerate(gyroscopic)]
    H = total(
        [free[i].product(inverse[i][j].product(free[j], order), order) for i in range(3) for j in range(3)]
    ).times(0.5)
    form = normal_form_of_series(H, order)
    maps = tuple(form.original(variable(j, 6)) for j in range(6))
    turning = int(np.abs(form.vectors[2]).argmax())  # nothing depends on it but rounding
    maps = tuple(f.where((f.exponents[:, turning] == 0) | (f.exponents.sum(1) == 1)) for f in maps)
    form = replace(form, series=form.series.where(form.series.exponents[:, turning] == 0))
    return Forms(form, maps, turning, lean, np.array([f.part(0).coefficients.sum() for f in gyroscopic]))


def _forms_about(scene: Scene, lean: float, order: int) -> Forms:
    (_, ratio, _), _ = MODEL.kind(scene, False)
    return _forms(ratio, *scene.inertias, scene.k, *scene.momenta, lean, order)


def _linear(scene: Scene, forms: Forms, state: Array) -> Any:
    """Return the coordinates (6,) that diagonalise H₂, for a state of `minimal` whose azimuth is ignored."""
    M, g = _momenta_at(scene, state[None, :3])
    p = M[0] @ state[3:] + g[0]
    x = np.concatenate([[state[0] - forms.lean, state[1], 0.0], p - forms.momentum])
    return np.linalg.solve(forms.form.vectors, x + 0j)


def _normal_start(scene: Scene, forms: Forms, order: int, start: Array) -> Any:
    """Return the normal coordinates (6,) of a state of `minimal` at azimuth 0. Raises DomainError if the iteration fails."""
    maps = _sums(tuple(f.through(order - 1) for f in forms.maps))
    linear = _linear(scene, forms, start)
    y, step = linear, np.inf
    for _ in range(_TRIES):
        residual = linear - maps.at(y[None])[0]
        y, previous, step = y + residual, step, float(np.abs(residual).max())
        if not step < previous or step < 1e-17:
            break
    if not step < 1e-13 or not np.abs(y).max() < 1:
        raise DomainError("averaged: the start is no small motion about an equilibrium; use model='minimal'")
    return y


def _states(scene: Scene, forms: Forms, order: int, start: Array, t: Array) -> tuple[Array, int]:
    """Return the states of `minimal` (n, 6) at times t (n,) from the normal form, and the number of evaluations. Raises
    DomainError if the centre of the swing moves far from the start."""
    from scipy.integrate import solve_ivp

    form, swing = forms.form, np.zeros(6, complex)
    swing[[0, 3]] = form.weights[0] * form.frequencies[0] * np.array([1, -1])
    slopes = _sums(tuple(form.series.through(order).derivative(j) for j in range(6)))

    def rate(_: float, y: Any) -> Any:
        slope = slopes.at(y[None])[0]
        return np.concatenate([form.weights * slope[3:], -form.weights * slope[:3]]) - swing * y

    def far(_: float, y: Any) -> float:
        return 1.0 - float(np.abs(form.vectors[:2] @ y).max())

    far.terminal = True  # type: ignore[attr-defined]
    begin, end = _normal_start(scene, forms, order, start), float(t[-1]) or 1e-9  # if the start alone is asked for
    run = solve_ivp(rate, (0.0, end), begin, "DOP853", t_eval=t, events=far, rtol=1e-13, atol=1e-16)
    if run.status != 0:
        raise DomainError("averaged: the swing's centre moves far from where it began; use model='minimal'")
    normal, maps = run.y.T * np.exp(swing * t[:, None]), _sums(tuple(f.through(order - 1) for f in forms.maps))
    old = np.concatenate([maps.at(chunk) for chunk in np.array_split(normal, len(normal) // _AT_ONCE + 1)])
    x = (old @ form.vectors.T).real
    q = x[:, :3] + [forms.lean, 0.0, start[2]]
    M, g = _momenta_at(scene, q)
    return np.hstack([q, np.linalg.solve(M, (x[:, 3:] + forms.momentum - g)[..., None])[..., 0]]), int(run.nfev)


def _centre(scene: Scene, state: Array) -> float:
    """Return the lean U at the centre of the swing through a state of `minimal`. Raises DomainError if it is far away."""
    forms = _forms_about(scene, float(state[0]), 2)
    slow = _linear(scene, forms, state)
    slow[[0, 3]] = 0.0
    offset = float((forms.form.vectors[0] @ slow).real)
    if not abs(offset) < 1:
        raise DomainError("averaged: the start is no small motion about an equilibrium; use model='minimal'")
    return float(state[0]) + offset


def _useful_orders(scene: Scene, lean: float, start: Array, turns: float, tol: float) -> tuple[int, ...]:
    """Return the orders of the normal form that may keep `tol` over a number of turns. Raises DomainError if there is none."""
    size = float(np.abs(_linear(scene, _forms_about(scene, lean, 2), start)).max()) ** 2
    least = zip(_ORDERS, LEAST_ERROR.value, strict=True)
    orders = tuple(order for order, factor in least if factor * turns * size ** (order // 2) <= tol)
    if not orders:
        raise DomainError(
            f"averaged: the swing is too wide for tol = {tol:g} over {turns:.0f} turns; use model='minimal'"
        )
    return orders


def averaged_motion(scene: Scene, t_end: float, tol: float, best: bool = False) -> ClosedMotion:
    """Return the motion up to t_end (s) by the normal form through order 6, or 8 if `tol` requires it.

    The motion through a pulse is integrated twice, to estimate its error. Raises SingularError without a bar. Raises
    DomainError if the spins are not opposite, the motion is not small, or the run ends within the pulse. Without `best` it also
    raises DomainError if no order can keep `tol`, and does not derive an order that cannot.
    """
    if scene.link is None:
        raise SingularError("averaged: the scene has no bar; use model='closed_form'")
    if scene.spins[0] != -scene.spins[1] or scene.spins[0] == 0:
        raise DomainError(
            f"averaged: spins {scene.spins[0]:g}, {scene.spins[1]:g} rad/s are not opposite: the axes part freely, and no "
            "motion stays small; use model='minimal', or lagrotor.theory.guiding_centre(scene).path(t) for the swing's centre"
        )
    units = natural_units(without_idle_shock(scene, t_end))
    natural, end, begin, starts, count = units.scene, t_end * units.rate, 0.0, [MODEL.start(units.scene)], 0
    if natural.shock:
        begin = natural.shock.end
        if begin >= end:
            raise DomainError("averaged: the run ends within the pulse; use model='minimal'")
    if not best and _ROUNDED * (1 + PACE * (end - begin)) > tol:
        raise DomainError(
            f"averaged: rounding exceeds tol = {tol:g} over so many turns; use a larger tol or a shorter run"
        )
    if natural.shock:
        pulsed = [_pulsed(natural, np.array([begin]), k) for k in (0, 1)]
        starts, count = [states[-1] for states, _ in pulsed], sum(evaluations for _, evaluations in pulsed)
    # The error may vanish at single times: sample a few swings all along the run.
    ends = (end - begin) * np.r_[np.geomspace(1e-3, 1, 9), np.linspace(0, 1, 9)]
    grid = np.unique(np.r_[0.0, np.clip(ends[:, None] - np.linspace(0, 8 * np.pi / PACE, 9), 0, end - begin).ravel()])
    lean = _centre(natural, starts[0])
    orders = _ORDERS if best else _useful_orders(natural, lean, starts[0], PACE * (end - begin) / (2 * np.pi), tol)

    def states(order: int, through: int, start: Array, t: Array) -> Array:
        nonlocal count
        sampled, evaluations = _states(natural, _forms_about(natural, lean, order), through, start, t)
        count += evaluations
        return sampled

    def distance(first: Array, second: Array) -> Array:
        apart = MODEL.observe(natural, first).axes - MODEL.observe(natural, second).axes
        return np.asarray(np.maximum.accumulate(np.linalg.norm(apart, axis=-1).max(0)))

    for order in orders:
        motions = [states(order, through, starts[0], grid) for through in (order, order - 2, order - 4)]
        last, previous = distance(motions[0], motions[1]), distance(motions[1], motions[2])
        rounded = _ROUNDED * (1 + PACE * grid)
        # Two orders decrease as the square of the motion. A faster decrease is not trusted: the first difference may differ
        # in kind (rotation about the joint line, which H₂ lacks), or the last nearly vanish (near the paired precession).
        square = float(np.abs(_normal_start(natural, _forms_about(natural, lean, order), order, starts[0])).max()) ** 2
        ratio = np.maximum(last / (previous + 10 * rounded), square)
        last = np.maximum(last, square * previous)
        errors = np.where(ratio < _SLOWEST, FALLING.value * ratio * last, UNKNOWN) + rounded
        if errors.max() <= tol:
            break
    if natural.shock:
        errors += 3 * distance(motions[0], states(order, order, starts[1], grid))
    errors = np.maximum.accumulate(errors)
    errors[errors > LOST.value] = UNKNOWN  # a large value is no estimate

    def motion(t: Array) -> tuple[Array, Array]:
        s = t * units.rate
        early, later = s[s < begin], s[s >= begin] - begin
        blocks = [_pulsed(natural, early, 0)[0]] if len(early) else []
        blocks += (
            [_states(natural, _forms_about(natural, lean, order), order, starts[0], later)[0]] if len(later) else []
        )
        observed = MODEL.observe(natural, np.vstack(blocks))
        return observed.axes, observed.rates * units.rate

    return ClosedMotion(
        float(errors[-1]), f"opposite spins averaged over the swing, by the normal form of order {order}", motion,
        lambda t: errors[np.minimum(np.searchsorted(grid, t * units.rate - begin), len(grid) - 1)], count,
    )  # fmt: skip


def _pulsed(scene: Scene, t: Array, k: int) -> tuple[Array, int]:
    """Return the states of `minimal` at times t through the pulse (n, 6), and the number of evaluations. Integration k = 0 is
    more exact than integration k = 1, which serves to estimate the error."""
    times = np.unique(np.r_[0.0, t])
    try:
        run = integrate_model(MODEL, scene, times, _PULSE[k], companion=k > 0, budget=_MOST)
    except StopError:
        raise DomainError("averaged: the motion through the pulse takes too many steps; use model='minimal'") from None
    return run.states[np.isin(times, t)], run.evaluations
