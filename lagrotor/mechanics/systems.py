"""A mechanical system, and what can be derived from it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import sympy as sp

from lagrotor.algebra import Decision
from lagrotor.errors import InputError
from lagrotor.formula_text import LONG
from lagrotor.mechanics import equilibria, glossary, steady_motions, symmetry, weakly_nonlinear
from lagrotor.mechanics.bodies import inertial_parameters, joint_forces
from lagrotor.mechanics.canonical import hamiltonians
from lagrotor.mechanics.equations import Equations
from lagrotor.mechanics.equilibria import Equilibrium
from lagrotor.mechanics.expressions import in_order
from lagrotor.mechanics.from_sympy import parts_from_sympy
from lagrotor.mechanics.lagrangian import Coordinates, coriolis_matrix
from lagrotor.renamed import accept_old_keywords
from lagrotor.result_display import in_lines, text_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import ArrayLike

    from lagrotor.mechanics.bodies.rigid_bodies import Frame
    from lagrotor.mechanics.robot_files.description import Symbols
    from lagrotor.mechanics.running.flow import Array, Rhs, Values
    from lagrotor.mechanics.running.monodromy import MonodromyMatrix
    from lagrotor.mechanics.running.root_loci import RootLocus, StabilityChart
    from lagrotor.mechanics.running.simulation import SystemRun
    from lagrotor.mechanics.running.switches import Event, Impact
    from lagrotor.numerics.integrate import Engine
    from lagrotor.numerics.languages import LanguageName

    Start = ArrayLike | Mapping[Any, float]

Kind = TypeVar("Kind", bound=Equations)
_FEW = 3  # coordinates of a system of bodies whose L is written out
_MOST_PRINTED = 6  # constraints or forces that are written out


def _point(at: Any) -> Any:
    return at.at if isinstance(at, Equilibrium) else at


@dataclass(frozen=True, repr=False)
class System(Equations):
    """A mechanical system: a Lagrangian L(q, v, t) with constraints, friction and forces.

    Unknown functions, as sympy's Function("U")(r), may stand in every expression, and `simulate` takes values for them.
    InputError is raised if the expressions do not describe a mechanical system.

    Attributes
    ----------
    c : Coordinates
        The coordinates.
    lagrangian : Expr or Energy
        L, or a sum of energies of bodies.
    constraints : sequence or mapping
        Expressions g(q, t) that stay zero; {name: expression} names their reactions.
    rolling : sequence or mapping
        Expressions f(q, v, t) that stay zero, affine in the velocities.
    dissipation : Expr
        Rayleigh's function D(q, v, t), in W, with the force −∂D/∂v.
    forces : sequence
        The generalised forces Q(q, v, t), one for each coordinate, or none.
    names : tuple of str
        The names of the constraints and then of the rolling constraints.
    velocities : mapping
        Quasi-velocities {u: expression affine in v}: one for each coordinate, or fewer if constraints determine the rest.
    states : mapping
        First-order states {x: f}, x' = f(q, v, x, t), for example the current of a motor. Forces, dissipation and other rates
        may contain x. System(states={…}), without coordinates, is a system of first-order equations.

    Examples
    --------
    >>> from sympy import cos, symbols
    >>> from lagrotor.mechanics import coordinates
    >>> m, l, g = symbols("m l g", positive=True)
    >>> c = coordinates("theta")
    >>> pendulum = System(c, m * l**2 * c.theta_dot**2 / 2 + m * g * l * cos(c.theta))
    >>> pendulum.mass_matrix, pendulum.forcing, pendulum.momenta
    (Matrix([[l**2*m]]), Matrix([[-g*l*m*sin(theta)]]), Matrix([[l**2*m*theta_dot]]))
    >>> pendulum.accelerations
    Matrix([[-g*sin(theta)/l]])
    >>> pendulum.motion[0]
    g*l*m*sin(theta) + l**2*m*theta_ddot
    """

    @staticmethod
    @accept_old_keywords
    def from_sympy(source: Any, q: Sequence[Any] = ()) -> "System":
        """Return the system of an object of sympy.physics.mechanics.

        Parameters
        ----------
        source : LagrangesMethod, KanesMethod, System or Expr
            The object, after its equations are formed; or a Lagrangian in dynamicsymbols.
        q : sequence, default ()
            The coordinates of a Lagrangian.

        Returns
        -------
        System
            The system in plain symbols.

        Examples
        --------
        >>> from sympy.physics.mechanics import dynamicsymbols
        >>> x = dynamicsymbols("x")
        >>> System.from_sympy(x.diff() ** 2 / 2 - x**2 / 2, (x,)).motion[0]
        x + x_ddot
        """
        return System(**parts_from_sympy(source, q))

    @staticmethod
    def from_urdf(path: "str | Path", symbols: "Symbols" = "inertia", base: str = "fixed") -> "RobotSystem":
        """Return the system of a robot in a URDF file.

        Decimals become exact rationals, and an angle such as 1.5707963 becomes π/2; the result's `notes` list these angles.
        Joint damping becomes dissipation, and a mimic joint becomes a constraint. Meshes, limits and dry friction are listed in
        `not_read`. Gravity is 9.81 m/s² along −z.

        Parameters
        ----------
        path : str or Path
            The URDF file.
        symbols : {"inertia", "all", "none"}, default 'inertia'
            "inertia": masses, centres of mass, inertias and g are symbols, and the result's `values` has their numbers.
            "all": lengths and dampings are symbols, too. "none": everything is a number. A zero of the file stays zero.
        base : {"fixed", "floating"}, default 'fixed'
            Whether the root link is fixed to the ground or free.

        Returns
        -------
        RobotSystem
            The system; its coordinates have the names of the file's joints.

        Raises
        ------
        InputError
            If the file is no valid URDF; the message names file, line, element and reason.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import mkdtemp
        >>> path = Path(mkdtemp(), "cart.urdf")
        >>> _ = path.write_text('''<robot name="cart"><link name="rail"/><link name="cart"><inertial><mass value="2"/>
        ... <inertia ixx="1" iyy="1" izz="1"/></inertial></link><joint name="x" type="prismatic"><parent link="rail"/>
        ... <child link="cart"/><axis xyz="1 0 0"/><dynamics damping="3"/></joint></robot>''')
        >>> cart = System.from_urdf(path)
        >>> cart.accelerations, cart.values[cart.lagrangian.bodies[0].mass]
        (Matrix([[-3*x_dot/m_cart]]), 2.0)
        """
        from lagrotor.mechanics.robot_files import description, urdf

        return RobotSystem(**description.parts_of(urdf.read_urdf(path, base), symbols))

    @staticmethod
    def from_mjcf(path: "str | Path", symbols: "Symbols" = "inertia") -> "RobotSystem":
        """Return the system of a machine in an MJCF file of MuJoCo.

        A body without <inertial> has the inertia of its geoms. Damping, springs and armatures of joints are read, and equality
        constraints hold exactly. Meshes, contacts, actuators and limits are listed in `not_read`. Included files must
        lie in the folder of the file.

        Parameters
        ----------
        path : str or Path
            The MJCF file.
        symbols : {"inertia", "all", "none"}, default 'inertia'
            "inertia": masses, centres of mass, inertias and g are symbols, and the result's `values` has their numbers.
            "all": lengths, dampings, stiffnesses and armatures are symbols, too. "none": everything is a number. A zero of
            the file stays zero.

        Returns
        -------
        RobotSystem
            The system; its coordinates have the names of the file's joints.

        Raises
        ------
        InputError
            If the file is no valid MJCF; the message names file, line, element and reason.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import mkdtemp
        >>> path = Path(mkdtemp(), "mass.xml")
        >>> _ = path.write_text('''<mujoco><worldbody><body name="mass"><joint name="z" type="slide" stiffness="8"/>
        ... <geom type="box" size="1 1 1" mass="2"/></body></worldbody></mujoco>''')
        >>> System.from_mjcf(path, symbols="none").motion[0]
        8*z + 2*z_ddot + 981/50
        """
        from lagrotor.mechanics.robot_files import description, mjcf

        return RobotSystem(**description.parts_of(mjcf.read_mjcf(path), symbols))

    @property
    def cyclic(self) -> tuple[sp.Symbol, ...]:
        """The coordinates whose momentum is conserved.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("r phi")
        >>> System(c, (c.r_dot**2 + c.r**2 * c.phi_dot**2) / 2 + 1 / c.r).cyclic
        (phi,)
        """
        return symmetry.cyclic_coordinates(self)

    def invariance(self, xi: Sequence[sp.Expr], gauge: sp.Expr = sp.S.Zero) -> Decision:
        """Decide if δL + Q · ξ = dF/dt and G ξ = 0 identically: then p · ξ − F is conserved.

        The condition is sufficient. A ξ that preserves the constraints only on their surface does not satisfy it.

        Parameters
        ----------
        xi, gauge : sequence, Expr
            The n components of ξ(q, v, t) and the gauge function F(q, v, t).

        Returns
        -------
        Decision
            The answer "zero" if the condition holds, with its domain.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x y")
        >>> fall = System(c, (c.x_dot**2 + c.y_dot**2) / 2 - 9 * c.y)
        >>> fall.invariance((1, 0)).answer, fall.invariance((0, 1)).answer
        ('zero', 'nonzero')
        """
        return symmetry.invariance(self, xi, gauge)

    def noether(self, xi: Sequence[sp.Expr], gauge: sp.Expr = sp.S.Zero) -> symmetry.FirstIntegral:
        """Return the Noether integral p · ξ − F of a symmetry ξ (Arnold §20).

        Parameters
        ----------
        xi, gauge : sequence, Expr
            The n components of ξ(q, v, t) and the gauge function F with δL = dF/dt.

        Returns
        -------
        FirstIntegral
            The conserved quantity and the domain of the decision.

        Raises
        ------
        NotASymmetryError
            If `invariance` does not answer "zero".

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x y")
        >>> plane = System(c, (c.x_dot**2 + c.y_dot**2) / 2 - (c.x**2 + c.y**2) ** 2)
        >>> plane.noether((-c.y, c.x)).expression
        x*y_dot - x_dot*y
        """
        return symmetry.noether(self, xi, gauge)

    def noether_rate(self, xi: Sequence[sp.Expr]) -> sp.Expr:
        """Return d/dt (p · ξ) = δL + Q · ξ + λ · (G ξ) along a motion.

        Parameters
        ----------
        xi : sequence
            The n components of ξ(q, v, t).

        Returns
        -------
        Expr
            The rate, with the symbols of `multipliers`.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> System(c, c.x_dot**2 / 2, dissipation=c.x_dot**2).noether_rate((1,))
        -2*x_dot
        """
        return symmetry.noether_rate(self, xi)

    def conserved(self, f: sp.Expr) -> Decision:
        """Decide if f(q, v, t) is a first integral.

        Parameters
        ----------
        f : Expr
            An expression in q, v and t.

        Returns
        -------
        Decision
            "zero" if df/dt vanishes along every motion. Under constraints the answer is "undecided" if df/dt does not vanish
            identically, since it may vanish on the constraints.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> spring = System(c, c.x_dot**2 / 2 - c.x**2 / 2)
        >>> spring.conserved(c.x_dot**2 + c.x**2).answer
        'zero'
        """
        return symmetry.conserved(self, f)

    def routh(self: Kind, cyclic: "str | Sequence[str | sp.Symbol] | Mapping[str | sp.Symbol, sp.Expr]") -> Kind:
        """Return the system in the other coordinates, with the Routhian R = L − Σ p v as its Lagrangian.

        Forces, friction and constraints are carried over. The eliminated velocities are v = −∂R/∂p.
        Goldstein §8.3 has the opposite sign of R.

        Parameters
        ----------
        cyclic : str, sequence or mapping
            Names of cyclic coordinates, "phi psi", whose momenta are then called p_phi, p_psi; or a mapping from coordinates
            to momenta. L must be quadratic in the velocities of these coordinates.

        Returns
        -------
        System
            The reduced system.

        Raises
        ------
        NotASymmetryError
            If a coordinate is not cyclic.
        DomainError
            If L is not quadratic in a cyclic velocity.
        SingularError
            If the momenta do not determine the cyclic velocities.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("r phi")
        >>> kepler = System(c, (c.r_dot**2 + c.r**2 * c.phi_dot**2) / 2 + 1 / c.r)
        >>> kepler.routh("phi").L
        -p_phi**2/(2*r**2) + r_dot**2/2 + 1/r
        """
        return symmetry.routh(self, cyclic)

    def hamiltonian(self, momenta: Sequence[sp.Symbol] | None = None) -> hamiltonians.Hamiltonian:
        """Return H = p·v − L with the momenta p = ∂L/∂v.

        Parameters
        ----------
        momenta : sequence or None, optional
            Symbols of the momenta; p_q for each coordinate q by default.

        Returns
        -------
        Hamiltonian
            H(q, p, t) with its brackets.

        Raises
        ------
        DomainError
            If forces, friction or constraints act, or L is not quadratic in the velocities.
        SingularError
            If det M vanishes identically.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> System(c, c.x_dot**2 / 2 - c.x**2 / 2).hamiltonian().H
        p_x**2/2 + x**2/2
        """
        return hamiltonians.hamiltonian(self, momenta)

    def equilibria(
        self,
        unknowns: str | Sequence[str | sp.Symbol] = (),
        values: Mapping[Any, Any] | None = None,
        box: Mapping[Any, tuple[Any, Any]] | None = None,
    ) -> tuple[Equilibrium, ...]:
        """Return the configurations at rest: ∂L/∂q + Q + Gᵀ λ = 0 and g = 0 at v = 0.

        Without a box the equilibria are exact, and angles in sines and cosines lie between −π and π. With values and a box,
        interval Newton's method encloses all equilibria in the box, also under one constraint g(q) = 0. A pole of a force is
        no equilibrium. If an edge is a decimal or irrational number, as 0.3 or π, every number that rounds to it is in the
        box.

        Parameters
        ----------
        unknowns : str or sequence, default ()
            Names of the symbols to solve for; the coordinates by default. In a system from `routh` a momentum may be unknown:
            solving for p_phi gives the momentum of the steady motion at every inclination.
        values : mapping or None, optional
            {symbol or name: number} for all parameters.
        box : mapping or None, optional
            {coordinate: (lowest, highest)} for each coordinate.

        Returns
        -------
        tuple of Equilibrium
            Values of the unknowns, and the conditions under which they are real. With a box they are numbers with an
            `enclosure`.

        Raises
        ------
        InputError
            If the conditions depend on time or cannot be solved exactly.
        SingularError
            If a part of the box stays undecided, for example around equilibria that are not isolated.

        Warns
        -----
        LagrotorWarning
            If nothing is decided where a force has no derivative or no value; the message names these places.

        Examples
        --------
        >>> from sympy import cos
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("theta")
        >>> [dict(e.at) for e in System(c, c.theta_dot**2 / 2 + cos(c.theta)).equilibria()]
        [{theta: 0}, {theta: pi}]
        """
        return equilibria.equilibria(self, unknowns, values, box)

    def rest(self, near: "Mapping[Any, Any] | Equilibrium", values: "Values") -> Equilibrium:
        """Find the equilibrium to which Newton's method leads from a configuration, also in closed loops.

        The steps are limited, so that the equilibrium is near the configuration; it may be unstable. Newton's method stops at
        the rounding error, so that `linearise` accepts the result. If equilibria are not isolated, the result is one of them.

        Parameters
        ----------
        near : mapping or Equilibrium
            {coordinate or state: number}. Coordinates on which the motion does not depend may be left out. The
            configuration is first moved onto the constraints.
        values : mapping
            {symbol or name: number} for all parameters.

        Returns
        -------
        Equilibrium
            The coordinates and first-order states, the largest acceleration or rate that remains there, and the stability of
            the linearised system.

        Raises
        ------
        InputError
            If a force or a constraint depends on time, or a force jumps.
        ConstraintError
            If no configuration near to the given one satisfies the constraints.
        SingularError
            If Newton's method does not converge.

        Examples
        --------
        >>> from sympy import cos
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x theta")
        >>> swing = System(c, (c.x_dot**2 + c.theta_dot**2) / 2 + cos(c.theta) - c.x**2, constraints=(c.x - c.theta - 1,))
        >>> place = swing.rest({"x": 1, "theta": 0}, {})
        >>> round(place.at[c.theta], 6), place.residual < 1e-14
        (-0.684037, True)
        """
        from lagrotor.mechanics.running import function_values, nearest_rest

        self, values = function_values.put_functions("rest", self, values)
        return nearest_rest.nearest_rest(self, near.at if isinstance(near, Equilibrium) else near, values)

    def same_as(self, other: Equations) -> Decision:
        """Decide if two systems have the same accelerations in the same coordinates.

        Lagrangians may differ by a factor and a total time derivative. The answer is "undecided" if the systems consist of
        blocks without interaction that have different factors, or if they agree only on the constraints.

        Parameters
        ----------
        other : System
            The other system.

        Returns
        -------
        Decision
            "zero", or "nonzero" with a witness.

        Raises
        ------
        InputError
            If the coordinates differ: `in_coordinates` rewrites one system in those of the other.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> System(c, c.x_dot**2 / 2).same_as(System(c, c.x_dot**2 + c.x * c.x_dot)).answer
        'zero'
        """
        return symmetry.same_as(self, other)

    def in_coordinates(self: Kind, c: Coordinates, where: Mapping[sp.Symbol, sp.Expr]) -> Kind:
        """Return the system in new coordinates Q.

        In L, D and the constraints q(Q, t) and v = dq/dt are substituted. The virtual work of the forces stays the same, so
        that the new ones are (∂q/∂Q)ᵀ times the old. Constraints that vanish identically are left out.

        Parameters
        ----------
        c : Coordinates
            The new coordinates; fewer where they solve constraints.
        where : mapping
            {old coordinate: expression in the new ones and t}. An old coordinate that is not named must be among the new
            ones.

        Returns
        -------
        System
            The same system.

        Examples
        --------
        >>> from sympy import cos, sin
        >>> from lagrotor.mechanics import coordinates
        >>> c, polar = coordinates("x y"), coordinates("theta")
        >>> plane = System(c, (c.x_dot**2 + c.y_dot**2) / 2 + 9 * c.x, constraints=(c.x**2 + c.y**2 - 1,))
        >>> plane.in_coordinates(polar, {c.x: cos(polar.theta), c.y: sin(polar.theta)}).equilibria()[0].at
        {theta: 0}
        """
        return symmetry.in_coordinates(self, c, where)

    def lindstedt_poincare(
        self, order: int, small: sp.Symbol, at: Any = 0, amplitude: sp.Symbol | None = None
    ) -> weakly_nonlinear.Oscillation:
        """Return the Lindstedt–Poincaré series of the periodic motions about the equilibrium q = at.

        Parameters
        ----------
        order : int
            The highest power of `small`.
        small : Symbol
            Either a parameter, and then the system must be linear where it is zero; or a new symbol, and then it is the
            amplitude, the value of q at phase 0 minus `at`.
        at : Expr, default 0
            The equilibrium.
        amplitude : Symbol or None, optional
            The symbol of the amplitude if `small` is a parameter; A by default.

        Returns
        -------
        Oscillation
            The frequency and the motion as series, each with its O() term.

        Raises
        ------
        InputError
            For several coordinates, constraints, a system that depends on time, a motion that is damped or grows, or an
            `at` that is no equilibrium.
        DomainError
            If the equation is no polynomial.

        Examples
        --------
        >>> from sympy import Symbol, cos
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("theta")
        >>> System(c, c.theta_dot**2 / 2 + cos(c.theta)).lindstedt_poincare(2, Symbol("a")).frequency
        1 - a**2/16 + O(a**3)
        """
        return weakly_nonlinear.oscillation(self, order, small, at, amplitude)

    def averaged(self, order: int, small: sp.Symbol, frequency: Any = None) -> weakly_nonlinear.AveragedMotion:
        """Return the slow motion of the amplitudes of q = a cos νt + b sin νt.

        Time may enter by sines and cosines whose frequencies are rational multiples of ν. A detuning is written into the
        system, ω² = ν² + small σ.

        Parameters
        ----------
        order : int
            The highest power of `small`, 1 or 2.
        small : Symbol
            A parameter. Where it is zero, the system must be q'' = −ν² q.
        frequency : Expr or None, optional
            The frequency ν in rad/s; by default the frequency of the system where `small` is zero.

        Returns
        -------
        AveragedMotion
            The rates of a and b.

        Raises
        ------
        InputError
            For several coordinates, constraints, another order, or a system that is not q'' = −ν² q at small = 0.
        DomainError
            If the equation is no polynomial in q, q' and such functions of time.

        Examples
        --------
        >>> from sympy import Symbol
        >>> from lagrotor.mechanics import coordinates
        >>> c, eps = coordinates("x"), Symbol("eps", positive=True)
        >>> damped = System(c, c.x_dot**2 / 2 - c.x**2 / 2, dissipation=eps * c.x_dot**2 / 2)
        >>> damped.averaged(1, eps).polar
        (-eps*r/2, 0)
        """
        return weakly_nonlinear.averaged(self, order, small, frequency)

    def __repr__(self) -> str:
        many, written = len(self.bodies), not self.bodies or len(self.c.q) <= _FEW
        rows = {"coordinates": text_of(self.c.q), "L": text_of(self.L) if written else LONG} if self.c.q else {}
        if many and rows["L"] == LONG:
            rows["L"] = f"the energy of {many} {'body' if many == 1 else 'bodies'}"
        for name in ("constraints", "rolling"):
            if each := getattr(self, name):
                rows[name] = (
                    ", ".join(f"{text_of(e)} = 0" for e in each) if len(each) <= _MOST_PRINTED else str(len(each))
                )
        if self.forces and len(self.forces) <= _MOST_PRINTED:
            rows["forces"] = text_of(self.forces)
        if self.dissipation != 0:
            rows["dissipation"] = text_of(self.dissipation)
        rows |= {f"{text_of(x)}'": text_of(f) for x, f in self.states}
        return in_lines("System", rows)

    def latex(self) -> str:
        r"""Return the equations of motion and the constraints as an `align` of LaTeX.

        Returns
        -------
        str
            One numbered row for each equation.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> print(System(c, c.x_dot**2 / 2 - c.x**2 / 2).latex())
        \begin{align}
        \ddot{x} + x &= 0
        \end{align}
        """
        return glossary.in_latex(self)

    def _repr_markdown_(self) -> str:
        return glossary.in_markdown(self)

    def linearise(
        self,
        at: "Mapping[Any, Any] | Equilibrium",
        values: "Values | None" = None,
        inputs: Sequence[sp.Symbol] = (),
        outputs: Sequence[sp.Expr] = (),
    ) -> Any:
        """Linearise about an equilibrium or a steady motion, also where bodies roll.

        Parameters
        ----------
        at : mapping or Equilibrium
            {coordinate or velocity: value}; velocities that are not named are zero.
        values : mapping or None, optional
            {symbol or name: number} for all parameters.
        inputs : sequence, default ()
            Parameters u of the system. They are zero at the point unless `at` or `values` names them.
        outputs : sequence, default ()
            Expressions y in q, v, a and the multipliers, which are measured.

        Returns
        -------
        LinearSystem, StateEquations or StateSpace
            Without values M a + C v + K q = 0 in symbols, a `LinearSystem`. With inputs, outputs or first-order states, or
            about a motion that rolls or is written in quasi-velocities, x' = A x + B u, y = C x + D u in symbols, a
            `StateEquations`.
            With values the same in numbers with the eigenvalues of A in 1/s, a `StateSpace`.

        Raises
        ------
        SingularError
            If an acceleration at the point is not zero, or the mass matrix is singular there.
        ConstraintError
            If the point is off the constraints.
        InputError
            If the coefficients change with time.

        Examples
        --------
        >>> from sympy import cos, symbols
        >>> from lagrotor.mechanics import coordinates
        >>> (l, g), c = symbols("l g", positive=True), coordinates("theta")
        >>> pendulum = System(c, l**2 * c.theta_dot**2 / 2 + g * l * cos(c.theta))
        >>> pendulum.linearise({"theta": 0}).modes()[0].rate
        I*sqrt(g)/sqrt(l)
        >>> abs(pendulum.linearise({"theta": 0}, {l: 1, g: 9}).rates).round(9)
        array([3., 3.])
        """
        for name, listed in (("inputs", inputs), ("outputs", outputs)):
            if isinstance(listed, str) or not isinstance(listed, Sequence | sp.MatrixBase):
                raise InputError(f"linearise: {name} = {listed!r} must be a tuple")
        if len({*map(str, inputs)}) < len(inputs) or not all(isinstance(u, sp.Symbol | str) for u in inputs):
            raise InputError(
                f"linearise: inputs = {inputs} must be different symbols: for a function F(t) write a symbol F"
            )
        point = _point(at)
        if not isinstance(point, Mapping):
            raise InputError(f"linearise: at = {at!r} must be an equilibrium or {{coordinate or velocity: value, …}}")
        if values is None:
            moves = any(str(s) in map(str, self.speeds) and x != 0 for s, x in dict(point).items())
            carried = self.kinematics and any(self.kinematics.velocity.xreplace(dict.fromkeys(self.speeds, sp.S.Zero)))
            if inputs or outputs or carried or self.states or (moves and (self.rolling or self.kinematics)):
                return steady_motions.state_equations(self, point, inputs, outputs)
            return steady_motions.linearise(self, at)
        from lagrotor.mechanics.running import function_values, state_space

        self, values = function_values.put_functions("linearise", self, values)
        return state_space.state_space(self, point, values, inputs, outputs)

    def floquet(self, at: "Mapping[Any, Any] | Equilibrium", values: "Values", period: float) -> "MonodromyMatrix":
        """Return the monodromy matrix of a periodic motion with its multipliers.

        Parameters
        ----------
        at : mapping or Equilibrium
            {coordinate or velocity: value} at t = 0, or at the time that `at` gives for t. Rest in a driven system is a
            periodic motion, too.
        values : mapping
            {symbol or name: number} for all parameters.
        period : float
            The period of the motion in s; for a state of rest, the period of the drive.

        Returns
        -------
        MonodromyMatrix
            The matrix and its multipliers, each with its error; a multiplier below its error is NaN.

        Raises
        ------
        InputError
            If the motion does not return after the period, or forces jump.
        ConstraintError
            If the point is off the constraints.

        Examples
        --------
        >>> from math import pi
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> spring = System(c, c.x_dot**2 / 2 - c.x**2 / 2)
        >>> abs(spring.floquet({"x": 1}, {}, 2 * pi).multipliers).round(6)
        array([1., 1.])
        """
        from lagrotor.mechanics.running import function_values, monodromy

        self, values = function_values.put_functions("floquet", self, values)
        return monodromy.monodromy_matrix(self, _point(at), values, period)

    def root_locus(
        self, at: "Mapping[Any, Any] | Equilibrium", values: "Values", symbol: sp.Symbol | str, numbers: "ArrayLike"
    ) -> "RootLocus":
        """Compute the rates of small motion as one symbol takes numbers.

        Parameters
        ----------
        at : mapping or Equilibrium
            {coordinate or velocity: value}, which may be expressions in the symbol.
        values : mapping
            {symbol or name: number} for the other parameters.
        symbol : Symbol or str
            The parameter that changes.
        numbers : array_like
            The values of `symbol`, increasing, shape (n,).

        Returns
        -------
        RootLocus
            The rates in 1/s, and the values of `symbol` at which the motion becomes stable or unstable.

        Examples
        --------
        >>> from sympy import Symbol
        >>> from lagrotor.mechanics import coordinates
        >>> c, k = coordinates("x"), Symbol("k", real=True)
        >>> spring = System(c, c.x_dot**2 / 2 - k * c.x**2 / 2)
        >>> abs(round(spring.root_locus({"x": 0}, {}, k, [-1, 2]).boundaries[0], 6))
        0.0
        """
        from lagrotor.mechanics.running import function_values, root_loci

        self, values = function_values.put_functions("root_locus", self, values)
        return root_loci.root_locus(self, _point(at), values, symbol, numbers)

    def stability_chart(
        self,
        at: "Mapping[Any, Any] | Equilibrium",
        values: "Values",
        numbers: "Mapping[Any, ArrayLike]",
        period: Any = None,
    ) -> "StabilityChart":
        """Compute the largest growth rate of small motion over two symbols.

        It takes one evaluation for each pair of numbers, and twenty for each point of a boundary.

        Parameters
        ----------
        at : mapping or Equilibrium
            {coordinate or velocity: value}, which may be expressions in the symbols.
        values : mapping
            {symbol or name: number} for the other parameters.
        numbers : mapping
            {symbol: increasing numbers} of two symbols.
        period : optional
            The period of a periodic motion in s, a number or an expression in the symbols. The growth rate is then that of
            the largest Floquet multiplier.

        Returns
        -------
        StabilityChart
            The growth rates in 1/s, and the points of the boundary.

        Examples
        --------
        >>> from sympy import symbols
        >>> from lagrotor.mechanics import coordinates
        >>> c, (k, d) = coordinates("x"), symbols("k d", real=True)
        >>> spring = System(c, c.x_dot**2 / 2 - k * c.x**2 / 2, forces=(-d * c.x_dot,))
        >>> spring.stability_chart({"x": 0}, {}, {k: [1, 2], d: [-1, 2]}).growth.round(3)
        array([[ 0.5,  0.5],
               [-1. , -1. ]])
        """
        from lagrotor.mechanics.running import function_values, root_loci

        self, values = function_values.put_functions("stability_chart", self, values)
        return root_loci.stability_chart(self, _point(at), values, numbers, period)

    def consistent(
        self, values: "Values", q0: "Start", v0: "Start | None" = None, t: float = 0.0
    ) -> "tuple[Array, Array]":
        """Return the state on the constraints that is nearest to (q0, v0) in the mass metric.

        Parameters
        ----------
        values : mapping
            {symbol or name: number} for all parameters.
        q0, v0 : array_like or mapping
            Coordinates, shape (n,), and velocities (n,) or quasi-velocities (m,), or {symbol or name: number} for each. Without
            v0 the system is at rest.
        t : float, default 0.0
            The time in s.

        Returns
        -------
        tuple of ndarray
            q, shape (n,), and v (n,), or the quasi-velocities u (m,).

        Raises
        ------
        ConstraintError
            If Newton's method does not reach the constraints.
        SingularError
            If the constraints are dependent.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x y")
        >>> ring = System(c, (c.x_dot**2 + c.y_dot**2) / 2, constraints=(c.x**2 + c.y**2 - 1,))
        >>> q, v = ring.consistent({}, q0={"x": 2, "y": 0}, v0={"x_dot": 1, "y_dot": 1})
        >>> q.round(9), v.round(9)
        (array([1., 0.]), array([0., 1.]))
        """
        from lagrotor.mechanics.running import function_values, initial_state

        q, v = initial_state.numbers_of_start("consistent", self, q0, v0)
        self, values = function_values.put_functions("consistent", self, values)
        return initial_state.consistent("consistent", self, values, q, v, t)

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of the joints: those that carry bodies, from the ground outward, then those that close loops.

        A joint without a name is called after its coordinates, unless another joint or a constraint has that name.

        Examples
        --------
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> c = coordinates("alpha beta")
        >>> upper = Frame(c).pin("alpha", name="shoulder").moved(0, -1)
        >>> System(c, upper.pin("beta").body(mass=1, inertia=(1, 1, 1)).kinetic).joints
        ('shoulder', 'beta')
        """
        return joint_forces.joint_names(self)

    def joint_force(self, name: str, axes: str = "ground") -> joint_forces.JointForce:
        """Return the force and the torque in a joint as expressions; `run.reactions` has the numbers along a run.

        The frame before the joint exerts them on the frame after it, at the origin of the second frame. They contain the
        drive, the spring and the friction of the joint. A plain entry of `forces` acts in the joint of its coordinate. A load
        made by `Frame.force` or `Frame.torque` acts on its frame.

        Parameters
        ----------
        name : str
            The name of the joint: see `joints`.
        axes : str, default 'ground'
            The axes of the components: "ground", or "joint" for the frame after the joint.

        Returns
        -------
        JointForce
            The columns `force` in N and `torque` in N m, expressions in q, v, a, t and `multipliers`. To have them along the
            motion, replace a by `accelerations`.

        Raises
        ------
        InputError
            If no joint has this name, if L has no bodies, or if it is unknown on which bodies a term acts. Such terms are a
            potential or friction that contains coordinates of several joints, and a constraint that no method of `Frame` made.

        Examples
        --------
        >>> from sympy import symbols
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> m, g, l = symbols("m g l", positive=True)
        >>> c = coordinates("theta")
        >>> rod = Frame(c).pin("theta", name="hook").body(mass=m, centre=(0, -l, 0))
        >>> swing = System(c, rod.kinetic - rod.potential((0, -g, 0)))
        >>> swing.joint_force("hook", axes="joint").force.T
        Matrix([[g*m*sin(theta) + l*m*theta_ddot, g*m*cos(theta) + l*m*theta_dot**2, 0]])
        """
        return joint_forces.joint_force(self, name, axes)

    def inverse_dynamics(
        self, q: Any = None, v: Any = None, a: Any = None, values: "Values | None" = None, t: float = 0.0
    ) -> Any:
        """Return the forces that must act, besides the system's own, to give it the accelerations a: τ = M a + h − Q.

        Under constraints τ includes the constraint forces Gᵀ λ. In a system with quasi-velocities, v and a are the
        quasi-velocities and their rates, and τ is the force conjugate to them. For a ball joint τ is the torque.

        Parameters
        ----------
        q, v, a : array_like, mapping or None, optional
            Coordinates, shape (n,) or (k, n), velocities and accelerations, as numbers or expressions. None stands for the
            symbols of the system.
        values : mapping or None, optional
            {symbol or name: number} for all parameters; it is not used if q, v or a are expressions.
        t : float, default 0.0
            The time in s.

        Returns
        -------
        Matrix or ndarray
            The forces, shape (n, 1) as expressions, (n,) or (k, n) as numbers.

        Examples
        --------
        >>> from sympy import symbols
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> m, g, l = symbols("m g l", positive=True)
        >>> c = coordinates("theta")
        >>> rod = Frame(c).pin("theta").body(mass=m, centre=(0, -l, 0))
        >>> swing = System(c, rod.kinetic - rod.potential((0, -g, 0)))
        >>> swing.inverse_dynamics()
        Matrix([[g*l*m*sin(theta) + l**2*m*theta_ddot]])
        >>> swing.inverse_dynamics([0], [0], [3], {m: 1, l: 2, g: 9})
        array([12.])
        """
        from lagrotor.mechanics.running import joint_programs

        return joint_programs.inverse_dynamics(self, q, v, a, values, t)

    def regressor(self) -> tuple[sp.Matrix, sp.Matrix]:
        """Return Y(q, v, a) and π: the generalised forces that move the bodies are Y π, linear in the inertial parameters π.

        Each body has ten parameters: m, the first moments m c, and the inertias xx, xy, xz, yy, yz, zz about the origin of its
        frame, in the axes of that frame. `inverse_dynamics` equals Y π if there are no applied forces, no
        friction and no other terms in L.

        Returns
        -------
        tuple of Matrix
            Y, shape (n, 10 N) for N bodies, and π in the symbols of the system, shape (10 N, 1).

        Raises
        ------
        InputError
            If L has energies other than `body.kinetic` and `body.potential` in one field.

        Examples
        --------
        >>> from sympy import symbols
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> m, g, l = symbols("m g l", positive=True)
        >>> c = coordinates("theta")
        >>> rod = Frame(c).pin("theta").body(mass=m, centre=(0, -l, 0))
        >>> Y, parameters = System(c, rod.kinetic - rod.potential((0, -g, 0))).regressor()
        >>> Y
        Matrix([[0, g*cos(theta), -g*sin(theta), 0, 0, 0, 0, 0, 0, theta_ddot]])
        >>> (Y * parameters)[0]
        g*l*m*sin(theta) + l**2*m*theta_ddot
        """
        return inertial_parameters.regressor(self)

    def base_parameters(self) -> inertial_parameters.BaseParameters:
        """Return the combinations of masses, first moments and inertias that forces and motions can determine, exactly.

        The energies are evaluated at random rational states. Exact elimination finds which parameters act only in combination.

        Returns
        -------
        BaseParameters
            The combinations, and the changes of parameters that leave the forces of every motion the same.

        Raises
        ------
        InputError
            If a joint's place depends explicitly on time, if there are constraints, or if L has energies other than
            `body.kinetic` and `body.potential` in one field.

        Examples
        --------
        >>> from sympy import symbols
        >>> from lagrotor.mechanics import Frame, coordinates
        >>> m, g, l = symbols("m g l", positive=True)
        >>> c = coordinates("theta")
        >>> rod = Frame(c).pin("theta").body(mass=m, centre=(0, -l, 0))
        >>> base = System(c, rod.kinetic - rod.potential((0, -g, 0))).base_parameters()
        >>> base.combinations.T, base.values.T
        (Matrix([[mx_1, my_1, Izz_1]]), Matrix([[0, -l*m, l**2*m]]))
        """
        return inertial_parameters.base_parameters(self)

    def coriolis_matrix(self) -> sp.Matrix:
        """Return the matrix C(q, v) of M a + C v + ∂V/∂q = Q, made of the Christoffel symbols; M' − 2 C is skew.

        It belongs to the velocities v, as `mass_matrix` does.

        Returns
        -------
        Matrix
            C, shape (n, n).

        Raises
        ------
        InputError
            If the mass matrix depends on velocities or time.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("r phi")
        >>> System(c, (c.r_dot**2 + c.r**2 * c.phi_dot**2) / 2).coriolis_matrix().tolist()
        [[0, -phi_dot*r], [phi_dot*r, r*r_dot]]
        """
        return coriolis_matrix(self.mass_matrix, self.c)

    def rhs(self, values: "Values", engine: "Engine" = "core") -> "Rhs":
        """Return the right-hand side of y' = f(t, y) in numbers; `accelerations` has it in symbols.

        Parameters
        ----------
        values : mapping
            {symbol or name: number} for all parameters.
        engine : Engine, default 'core'
            "core", or "fast" with heyoka.

        Returns
        -------
        callable
            (t, y) → y' for the state y = (q, v), 2 n numbers, or (q, u), n + m numbers, with m quasi-velocities u, each
            followed by the first-order states.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> System(c, c.x_dot**2 / 2 - c.x**2 / 2).rhs({})(0, [1, 2])
        [2.0, -1.0]
        """
        from lagrotor.mechanics.running import flow, function_values, initial_state

        self, values = function_values.put_functions("rhs", self, values)
        initial_state.check_values("rhs", self, values)
        return flow.rhs(self, values, engine)

    def export(self, language: "LanguageName", folder: "str | Path", name: str = "system") -> "tuple[Path, ...]":
        """Write the equations as functions of another language, for other tools.

        The functions are rhs, mass_matrix, forcing, inverse_dynamics, energy, joint_forces and jacobian. The jacobian is
        exact. The arguments are the time t, the parameters p and the state x, which is (q, u), then the first-order states.
        `name.json` has the order of states, parameters and outputs, with their units. A warning gives the reason if the
        function joint_forces cannot be written.

        Parameters
        ----------
        language : {"c", "casadi", "jax", "julia", "matlab"}
            The language. Octave reads the files of MATLAB.
        folder : str or Path
            The folder, which is made if it is missing.
        name : str, default 'system'
            The first part of the names of files and functions.

        Returns
        -------
        tuple of Path
            The files.

        Raises
        ------
        InputError
            If dry friction acts, a force contains a reaction, or an unknown function has no expression. If the folder has a
            file of that name that lagrotor did not write or that belongs to another system.

        Examples
        --------
        >>> from tempfile import mkdtemp
        >>> from sympy import cos, symbols
        >>> from lagrotor.mechanics import coordinates
        >>> (l, g), c = symbols("l g", positive=True), coordinates("theta")
        >>> pendulum = System(c, l**2 * c.theta_dot**2 / 2 + g * l * cos(c.theta))
        >>> [file.name for file in pendulum.export("c", mkdtemp(), "pendulum")]
        ['pendulum.h', 'pendulum.c', 'pendulum.json']
        """
        from lagrotor.mechanics.running import exports

        return exports.export(self, language, folder, name)

    def simulate(
        self,
        values: "Values",
        q0: "Start" = (),
        v0: "Start | None" = None,
        t: "ArrayLike | None" = None,
        tol: float = 1e-9,
        engine: "Engine" = "core",
        events: "Event | Impact | Sequence[Event | Impact]" = (),
        progress: "Callable[[float], None] | None" = None,
        x0: "Start" = (),
    ) -> "SystemRun":
        """Integrate the equations of motion. Where forces contain sign(w), or the dissipation |w|, bodies can stick and slip.

        The dissipation F √Q, with a quadratic form Q of velocities, is dry friction in several directions.

        A run that cannot reach its last time ends earlier with a LagrotorWarning, and `run.ending` gives the reason. Another
        warning names the time at which the constraints become dependent.

        Integration steps are short where a function of t alone changes fast, if the change lasts a ten-thousandth of the run;
        a briefer pulse may be missed. They are short, too, where an expression of coordinates or velocities changes within an
        eighth of their range, however narrow it is: exp(−((q − c)/w)²), tanh((q − c)/w). Narrow features of a callable, a table
        or a spline are not recognised: give an expression.

        Parameters
        ----------
        values : mapping
            {symbol or name: number} for every parameter, and for every unknown function an expression, a callable,
            callables (U, U', …) as far as the equations need derivatives, a table (x, y) or a spline of scipy. The run
            ends where the motion leaves a table.
        q0, v0 : array_like or mapping
            Coordinates and velocities, or quasi-velocities, at t[0]: arrays, or {symbol or name: number} for each. Without v0
            the system starts at rest.
        t : array_like
            Increasing times in s, shape (k,), which every run needs.
        tol : float, default 1e-09
            The largest error of the whole run, from 1e-13 to 0.1, relative to the sizes of coordinates, velocities and states.
            `run.error` and `run.errors` estimate it. It is below `tol` until the time `run.horizon`; a LagrotorWarning says so
            if that is before the end.
        engine : Engine, default 'core'
            "core", or "fast" with heyoka.
        events : Event, Impact or sequence, default ()
            Conditions that change the velocities or end the run.
        progress : callable or None, optional
            Called with the time in s of each evaluation, or of each step of a run with events.
        x0 : array_like or mapping, default ()
            The first-order states at t[0]: an array, or {symbol or name: number} for each.

        Returns
        -------
        SystemRun
            The motion at the times t.

        Raises
        ------
        InputError
            For a missing or impossible value, start, time, tolerance or event.
        ConstraintError
            For a start off the constraints.
        SingularError
            For a singular mass matrix.
        IntegrationError
            If no step succeeds, or the run would take more than 10⁸ evaluations.

        Examples
        --------
        >>> from lagrotor.mechanics import coordinates
        >>> c = coordinates("x")
        >>> spring = System(c, c.x_dot**2 / 2 - c.x**2 / 2)
        >>> run = spring.simulate({}, q0={"x": 1}, t=[0, 1, 2])
        >>> run.q[:, 0].round(6)
        array([ 1.      ,  0.540302, -0.416147])
        """
        from lagrotor.mechanics.running import initial_state, simulation

        if t is None:
            raise InputError(
                "simulate: t, the times in s, is missing: without v0 give it by name, t=np.linspace(0, 10, 101)"
            )
        q, v = initial_state.numbers_of_start("simulate", self, q0, v0)
        x = in_order("simulate: x0", x0, [x for x, _ in self.states])
        return simulation.simulate_system(self, values, q, v, t, tol, engine, events, progress, x)


@dataclass(frozen=True, repr=False)
class RobotSystem(System):
    """A System from a robot file, returned by `System.from_urdf` and `System.from_mjcf`.

    Attributes
    ----------
    c : Coordinates
    lagrangian : Energy
    constraints
    rolling
    dissipation
    forces
    names
    velocities
    states
        The fields of `System`.
    values : mapping
        The numbers of the file by symbol, for `simulate`, `rhs` and `linearise`; empty if the system has no symbols.
    start : mapping
        The coordinates in the position that the file describes, by name.
    links : mapping
        The frames of the links by the names of the file, for forces, points and constraints.
    joint_coordinates : mapping
        The coordinates of each joint by the names of the file. In other coordinates (`in_coordinates`, `routh`) it is empty,
        as are `start` and `links`.
    not_read : tuple of str
        The parts of the file that are left out, in words: meshes, contacts, actuators, limits.
    notes : tuple of str
        The changes, in words: decimals that are read as multiples of π, names that are changed.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> file = Path(mkdtemp(), "rod.urdf")
    >>> _ = file.write_text('''<robot name="rod"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.5"/>
    ... <mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
    ... <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>''')
    >>> rod = System.from_urdf(file)
    >>> rod.motion[0].subs(rod.values)
    0.6*hinge_ddot + 9.81*sin(hinge)
    """

    values: Mapping[sp.Symbol, float] = field(default_factory=dict, compare=False)
    start: Mapping[str, float] = field(default_factory=dict, compare=False)
    links: "Mapping[str, Frame]" = field(default_factory=dict, compare=False)
    joint_coordinates: Mapping[str, tuple[sp.Symbol, ...]] = field(default_factory=dict, compare=False)
    not_read: tuple[str, ...] = field(default=(), compare=False)
    notes: tuple[str, ...] = field(default=(), compare=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if any(frame.c != self.c for frame in self.links.values()):  # in_coordinates, routh
            for name in ("start", "links", "joint_coordinates"):
                object.__setattr__(self, name, {})

    def __repr__(self) -> str:
        many = len(self.notes) > _MOST_PRINTED
        notes = f"{len(self.notes)} changes, see the attribute notes" if many else "; ".join(self.notes)
        rows = {"not read": "; ".join(self.not_read), "notes": notes}
        return super().__repr__() + in_lines("", {name: text for name, text in rows.items() if text})
