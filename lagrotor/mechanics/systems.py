"""A mechanical system, and what can be derived from it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.mechanics import equilibria, glossary, steady_motions, symmetry, weakly_nonlinear
from lagrotor.mechanics.canonical import hamiltonians
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.from_sympy import parts_from_sympy

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from lagrotor.mechanics.running.flow import Array, Rhs, Values
    from lagrotor.mechanics.running.monodromy import MonodromyMatrix
    from lagrotor.mechanics.running.root_loci import RootLocus, StabilityChart
    from lagrotor.mechanics.running.simulation import SystemRun
    from lagrotor.mechanics.running.switches import Event, Impact
    from lagrotor.numerics.integrate import Engine


@dataclass(frozen=True)
class System(Equations):
    """System(c, L, constraints=(), rolling=(), dissipation=0, forces=()): a Lagrangian L(q, v, t), and what acts on it.

    The arguments are those of `Equations`, to which this class adds what is derived from them.

    Examples
    --------
    >>> from sympy import cos, symbols
    >>> from lagrotor.mechanics import coordinates
    >>> m, l, g = symbols("m l g", positive=True)
    >>> c = coordinates("theta")
    >>> pendulum = System(c, m * l**2 * c.v[0]**2 / 2 + m * g * l * cos(c.q[0]))
    >>> pendulum.motion[0]
    g*l*m*sin(theta) + l**2*m*theta_ddot
    >>> pendulum.linearise({c.q[0]: 0}).modes()[0].rate
    I*sqrt(g)/sqrt(l)
    """

    @staticmethod
    def from_sympy(given: Any, q: Sequence[Any] = ()) -> "System":
        """The system of what sympy.physics.mechanics has: see `from_sympy`."""
        return System(**parts_from_sympy(given, q))

    @property
    def cyclic(self) -> tuple[sp.Symbol, ...]:
        """The coordinates with a conserved momentum."""
        return symmetry.cyclic_coordinates(self)

    variation = symmetry.variation
    invariance = symmetry.invariance
    noether = symmetry.noether
    noether_rate = symmetry.noether_rate
    conserved = symmetry.conserved
    routh = symmetry.routh
    hamiltonian = hamiltonians.hamiltonian
    equilibria = equilibria.equilibria
    same_as = symmetry.same_as
    in_coordinates = symmetry.in_coordinates
    lindstedt_poincare = weakly_nonlinear.oscillation
    averaged = weakly_nonlinear.averaged
    latex = glossary.in_latex
    _repr_markdown_ = glossary.in_markdown

    def linearise(
        self,
        at: "Mapping[Any, Any] | Equilibrium",
        values: "Values | None" = None,
        inputs: Sequence[sp.Symbol] = (),
        outputs: Sequence[sp.Expr] = (),
    ) -> Any:
        """Small motion about an equilibrium or a steady motion, also where bodies roll.

        Without values: M a + C v + K q = 0 in symbols, see `steady_motions.linearise`; for inputs and outputs, and about a motion
        that rolls, A, B, C, D in symbols. With values: the numbers A, B, C, D and rates of x' = A x + B u, y = C x + D u.

        Parameters
        ----------
        at : Mapping[Any, Any] or Equilibrium
            The equilibrium, or the coordinates and velocities of the motion.
        values : Values or None, optional
            Of the parameters.
        inputs : sequence, default ()
            U, parameters, zero unless they have a value.
        outputs : sequence, default ()
            Y, expressions in q, v, a and the multipliers.

        Returns
        -------
            A LinearSystem, a StateEquations, or with values a StateSpace.

        Raises
        ------
        SingularError
            Where accelerations are left.
        ConstraintError
            Off the constraints.
        InputError
            Where the coefficients change with time.
        """
        for name, listed in (("inputs", inputs), ("outputs", outputs)):
            if isinstance(listed, str) or not isinstance(listed, Sequence | sp.MatrixBase):
                raise InputError(f"linearise: {name} = {listed!r} must be a tuple")
        if len({*map(str, inputs)}) < len(inputs) or not all(isinstance(u, sp.Symbol | str) for u in inputs):
            raise InputError(
                f"linearise: inputs = {inputs} must be different letters: of a function F(t) write a letter F"
            )
        point = at.at if isinstance(at, Equilibrium) else at
        if not isinstance(point, Mapping):
            raise InputError(f"linearise: at = {at!r} must be an equilibrium or {{coordinate or velocity: value, …}}")
        if values is None:
            moves = any(str(s) in map(str, self.speeds) and x != 0 for s, x in dict(point).items())
            carried = self.kinematics and any(self.kinematics.velocity.xreplace(dict.fromkeys(self.speeds, sp.S.Zero)))
            if inputs or outputs or carried or (moves and (self.rolling or self.kinematics)):
                return steady_motions.state_equations(self, point, inputs, outputs)
            return steady_motions.linearise(self, at)
        from lagrotor.mechanics.running import function_values, state_space

        self, values = function_values.put_functions("linearise", self, values)
        return state_space.state_space(self, point, values, inputs, outputs)

    def floquet(self, at: "Mapping[Any, Any]", values: "Values", period: float) -> "MonodromyMatrix":
        """Return the monodromy matrix of a periodic motion and its multipliers, each with its error and NaN where it is below it.

        Parameters
        ----------
        at : mapping
            Coordinates and velocities at t = 0, or at the value of t. A rest in a system that is driven is a motion, too.
        values : Values
            Of the parameters.
        period : float
            S; at rest that of what drives.

        Raises
        ------
        InputError
            Where the motion has not come back after the period, or forces jump.
        ConstraintError
            As `linearise`.
        """
        from lagrotor.mechanics.running import function_values, monodromy

        self, values = function_values.put_functions("floquet", self, values)
        return monodromy.monodromy_matrix(self, at, values, period)

    def root_locus(
        self, at: "Mapping[Any, Any]", values: "Values", letter: sp.Symbol | str, numbers: "ArrayLike"
    ) -> "RootLocus":
        """The rates of small motion as one letter takes numbers.

        Parameters
        ----------
        at : mapping
            Coordinates and velocities, which may be expressions in the letter.
        values : Values
            Of the other parameters.
        letter : Symbol or str
            The one that changes.
        numbers : array_like
            Increasing, (n,).

        Raises
        ------
        InputError
            Where the letter has a value already, and as `linearise`.
        """
        from lagrotor.mechanics.running import function_values, root_loci

        self, values = function_values.put_functions("root_locus", self, values)
        return root_loci.root_locus(self, at, values, letter, numbers)

    def stability_chart(
        self, at: "Mapping[Any, Any]", values: "Values", numbers: "Mapping[Any, ArrayLike]", period: Any = None
    ) -> "StabilityChart":
        """The largest growth of small motion over two letters: as many evaluations as numbers, and twenty for each boundary.

        Parameters
        ----------
        at : mapping
            Coordinates and velocities, which may be expressions in the letters.
        values : Values
            Of the other parameters.
        numbers : mapping
            {letter: increasing numbers, …}.
        period : optional
            Of a periodic motion, which grows by its multipliers: a number or an expression in the letters.

        Raises
        ------
        InputError
            As `root_locus`.
        """
        from lagrotor.mechanics.running import function_values, root_loci

        self, values = function_values.put_functions("stability_chart", self, values)
        return root_loci.stability_chart(self, at, values, numbers, period)

    def consistent(self, values: "Values", q0: "ArrayLike", v0: "ArrayLike", t: float = 0.0) -> "tuple[Array, Array]":
        """The state (q, v) on the constraints that is nearest to a start in the mass metric.

        Parameters
        ----------
        values : Values
            Of the parameters.
        q0 : array_like
            (N,).
        v0 : array_like
            (N,).
        t : float, default 0.0
            The time, s.

        Raises
        ------
        ConstraintError
            When it is not reached.
        SingularError
            Where the constraints are dependent.
        """
        from lagrotor.mechanics.running import function_values, initial_state

        self, values = function_values.put_functions("consistent", self, values)
        return initial_state.consistent("consistent", self, values, q0, v0, t)

    def rhs(self, values: "Values", engine: "Engine" = "core") -> "Rhs":
        """(t, y) → (v, a), for the state y = (q, v), an array (2 N,): see `running.flow`."""
        from lagrotor.mechanics.running import flow, function_values, initial_state

        self, values = function_values.put_functions("rhs", self, values)
        initial_state.check_values("rhs", self, values)
        return flow.rhs(self, values, engine)

    def simulate(
        self,
        values: "Values",
        q0: "ArrayLike",
        v0: "ArrayLike",
        t: "ArrayLike",
        tol: float = 1e-9,
        engine: "Engine" = "core",
        events: "Event | Impact | Sequence[Event | Impact]" = (),
        progress: "Callable[[float], None] | None" = None,
    ) -> "SystemRun":
        """Integrate the equations of motion. Forces that jump with sign(w) or |w| stick and slip.

        A run that cannot reach its last time is handed back up to where it came; `run.ending` says why, with a LagrotorWarning.
        One also names the time where it passed a position at which its constraints are dependent.

        Steps are as long as the motion allows, but short where a function of t alone changes faster than it mostly does: in
        pulses and at steps that are longer than a ten-thousandth of the run. A briefer pulse may be passed over. Steps are
        short, too, where an expression of coordinates or velocities changes within less than an eighth of their swing, however
        narrow it is: exp(−((q − c)/w)²), tanh((q − c)/w), 1/(1 + ((q − c)/w)²). The narrow parts of a callable, a table or a
        spline are not known: give an expression.

        Parameters
        ----------
        values : Values
            {symbol or name: number} for every parameter, and for every unknown function an expression, a callable,
            callables (U, U', …) as far as the equations need derivatives, a table (x, y) or a spline of scipy: where the
            motion leaves a table, the run ends.
        q0 : array_like
            At t[0], (N,).
        v0 : array_like
            At t[0], (N,); u (m,) for velocities of one's own.
        t : array_like
            Increasing times (n,), s.
        tol : float, default 1e-09
            The largest error of the whole run, relative to the sizes of coordinates and velocities. It is estimated;
            where it is not kept, a LagrotorWarning says up to which time it is, and what the error is: as `run.error`,
            `run.errors` and `run.horizon`.
        engine : Engine, default 'core'
            "core", or "fast" with heyoka.
        events : Event or Impact or Sequence[Event or Impact], default ()
            What changes the velocities or ends the run.
        progress : callable or None, optional
            Called with the time (s) of each evaluation by the core, and of each step of a run with events.

        Raises
        ------
        InputError
            For a value that is missing or makes no sense.
        ConstraintError
            For a start off the constraints.
        SingularError
            For a singular mass matrix.
        IntegrationError
            Where nothing can be reached, or a run would take more than 10⁸ evaluations.
        """
        from lagrotor.mechanics.running import simulation

        return simulation.simulate_system(self, values, q0, v0, t, tol, engine, events, progress)
