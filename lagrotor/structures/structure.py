"""`Structure`, any number of rotors and bars with its methods, and its TOML file."""

from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.files import path_of, write_text
from lagrotor.numerics.integrate import Engine
from lagrotor.pair.scene import Link, Rotor
from lagrotor.pair.scene_document import check_fields, part_of, read_document, toml_value
from lagrotor.structures import (
    characteristic,
    critical_spins,
    precession_law,
    resonances,
    response,
    small_motion,
    standing,
    steady_precession,
)
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.coefficients import Complex
from lagrotor.structures.exact.bar_closure import check_closure
from lagrotor.structures.exact.exact_motion import Drive
from lagrotor.structures.exact.structure_run import StructureRun, simulate_structure
from lagrotor.structures.resonances import Resonance

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Structure(Assembly):
    """N rotors on ground joints, with bars between their tips, under weight, springs and dampers.

    One number, rotor or link applies to all of them. Units are SI. Methods that linearise about upright raise InputError if a
    bar does not have its upright length. Methods that go beyond the linear motion need a structure without friction and without
    growing modes, with at most 8 degrees of freedom.

    Attributes
    ----------
    joints : tuple
        The ground joints (x, y), N pairs, m.
    bars : tuple
        Rigid bars (i, j) or (i, j, length in m). Rotors count from 0; the default length is that of upright axes.
    spins : tuple
        The angular velocities ω_i about the axes, N signed numbers, rad/s.
    rotor : tuple
        The `Rotor` of each joint.
    link : tuple
        The `Link` of each bar. Only the mass and the inertia of a link are used.
    gravity : float
        The acceleration of gravity along −z, m/s².
    load : tuple
        The point mass on each tip, kg.
    friction : tuple
        The friction on the tilting rate of each axis, N m s/rad.
    hinge : tuple
        The stiffness of the spring that pulls each axis upright, N m/rad.
    braces : tuple
        The springs and dampers, each a `Brace` or its four values.
    spin_friction : tuple
        The friction on each spin, N m s/rad.

    Raises
    ------
    InputError
        If bars cannot close, constraints are dependent, no degree of freedom remains, or a value is out of range.

    Examples
    --------
    >>> from lagrotor import Structure
    >>> corner = Structure([(0, 0), (1, 0), (1, 1)], bars=[(0, 1), (1, 2)], spins=[35, 0, 35], gravity=9.81, load=2)
    >>> bool(corner.stands()), round(corner.critical_spin(), 4)
    (True, 0.7215)
    """

    if TYPE_CHECKING:  # the types of the arguments; the fields are tuples

        def __init__(
            self, joints: Sequence[Sequence[float]], bars: Sequence[Sequence[float]] = (), spins: float | Sequence[float] = 0.0,
            rotor: Rotor | Sequence[Rotor] = ..., link: Link | Sequence[Link] = ..., gravity: float = 0.0,
            load: float | Sequence[float] = 0.0, friction: float | Sequence[float] = 0.0,
            hinge: float | Sequence[float] = 0.0, braces: Sequence[Brace | Sequence[Any]] = (),
            spin_friction: float | Sequence[float] = 0.0,
        ) -> None: ...  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        check_closure(self)

    def simulate(
        self, t: ArrayLike, tilt: ArrayLike | None = None, rates: ArrayLike | None = None, drive: Drive | None = None,
        ground: Drive | None = None, tol: float = 1e-9, engine: Engine = "core",
    ) -> StructureRun:  # fmt: skip
        """Integrate the exact motion from an initial state that holds at t[0].

        Tilt and rates are projected onto the bars in the metric of the mass matrix. The error is estimated from two runs, and
        from the energy where it is conserved. A LagrotorWarning is issued if the error exceeds `tol` or the run ends early.

        Parameters
        ----------
        t : array_like
            The increasing times (n,), s.
        tilt : array_like or None, optional
            The components x, y of the axes (N, 2), or the axes (N, 3). The default is upright.
        rates : array_like or None, optional
            The rates of the axes, (N, 2) or (N, 3), 1/s. The default is rest.
        drive : callable or None, optional
            A smooth function of t that returns the forces (N, 3) on the tips, N.
        ground : callable or None, optional
            A smooth function of t that returns the acceleration (3,) of the ground, m/s².
        tol : float, default 1e-9
            The largest error of an axis over the whole run, from 1e-13 to 0.1.
        engine : str, default "core"
            "core", or "fast" for heyoka (`pip install lagrotor[fast]`).

        Returns
        -------
        StructureRun
            The motion at the times that were reached.

        Raises
        ------
        InputError, ConstraintError, SingularError
            If an argument is invalid, the bars do not allow the tilt, or a bar is in line with both its axes.
        IntegrationError
            If no part of the motion can be computed.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> run = example("corner").simulate([0.0, 0.5, 1.0], tilt=[[0.01, 0.0]] * 3, tol=1e-8)
        >>> run.axes.shape, run.error < 1e-8
        ((3, 3, 3), True)
        """
        return simulate_structure(self, t, tilt, rates, drive, ground, tol, engine)

    def modes(self, inertia: bool = True) -> small_motion.Modes:
        """Compute the normal modes about upright, sorted by growth (largest first) and then by rate.

        Parameters
        ----------
        inertia : bool, default True
            False for the limit of fast spins, C u' + K u = 0, which has only the slow precessions (Nash et al., PNAS 112,
            14495 (2015)).

        Returns
        -------
        Modes
            The rates, growths and shapes of the modes.

        Raises
        ------
        InputError, SingularError
            If the fastest rate exceeds 10⁶ times the slowest; without inertia if no spin acts on some motion.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> example("corner").modes().rates.round(4).tolist()
        [1.171, 1.171, 6.444, 6.444]
        """
        return small_motion.modes(self, inertia)

    def steady_precession(self, mode: int = 0, tilt: float = 0.1) -> steady_precession.SteadyPrecession:
        """Find the periodic orbit that continues a normal mode to a finite tilt.

        If a conservation law allows a family of orbits of the same tilt, the orbit nearest to the mode is returned.

        Parameters
        ----------
        mode : int, default 0
            The number of the mode in `modes()`, from 0. The mode must oscillate without growth, and no other may have its rate.
        tilt : float, default 0.1
            The largest horizontal component of an axis in the mode, between 0.001 and 1.

        Returns
        -------
        SteadyPrecession
            The orbit and its Floquet multipliers.

        Raises
        ------
        InputError
            If the mode or tilt is invalid, friction acts, or no such orbit is reached.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> orbit = example("top").steady_precession(mode=0, tilt=0.1)
        >>> round(orbit.period, 6), orbit.growth
        (6.935291, 0.0)
        """
        return steady_precession.steady_precession(self, mode, tilt)

    def precession_law(self, mode: int = 0) -> precession_law.PrecessionLaw:
        """Expand rate and stability of the precessions of a mode in powers of the tilt.

        The law is accurate if no multiple of the rate is close to another rate. For the exact orbit see `steady_precession`.

        Parameters
        ----------
        mode : int, default 0
            The number of the mode in `modes()`, from 0. The mode must oscillate without growth, and no other may have its rate.

        Returns
        -------
        PrecessionLaw
            The rate and the multipliers as functions of the tilt.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> law = example("top").precession_law(0)
        >>> round(law.rate, 6), round(float(law.rate_at(0.1)), 6)
        (0.906527, 0.905974)
        """
        return precession_law.precession_law(self, mode)

    def stands(self) -> standing.Standing:
        """Decide if the upright position is stable, linearly and beyond.

        Returns
        -------
        Standing
            The answer, with its reason in words. Its truth value is linear stability.

        Raises
        ------
        InputError
            If the rates are too far apart for double precision.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> corner = example("corner").stands()
        >>> bool(corner), corner.kind
        (True, 'holds')
        """
        return standing.stands(self)

    def critical_spin(self) -> float:
        """Return the factor on all spins above which the linear motion stays bounded.

        Above this factor, resonances may still amplify a push at particular factors: see `spin_intervals`.

        Returns
        -------
        float
            The factor: 0 if no spin is needed, inf if no factor suffices.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> round(example("corner").critical_spin(), 6)
        0.721478
        """
        return critical_spins.critical_spin(self)

    def spin_intervals(self, push: float) -> tuple[tuple[float, float], ...]:
        """Return the factors on all spins at which no push of a given size topples the structure.

        The pushes that resonances need are computed at 16 factors up to 12 times the critical factor, and at the resonances
        between these factors. The ends of the intervals have an error of 1/32 of their distance from the critical factor.
        Exceptions between the samples may be missed.

        Parameters
        ----------
        push : float
            The root of the sum of squares of the rates of all axes at the start, rad/s.

        Returns
        -------
        tuple
            Intervals (low, high) of the factor; the last `high` may be inf. The tuple is empty if no factor is known to
            suffice.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> [(round(low, 2), round(high, 2)) for low, high in example("corner").spin_intervals(0.01)]
        [(0.72, 0.76), (0.77, 0.83), (0.83, inf)]
        """
        return resonances.spin_intervals(self, push)

    def largest_push(self) -> resonances.LargestPush:
        """Return the size below which no push from upright topples the structure.

        The terms of the Hamiltonian through fourth order decide. The value is 0 if the linear motion grows.

        Returns
        -------
        LargestPush
            The size in rad/s, and the resonance that limits it.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> round(float(example("corner").largest_push()), 4)
        0.1522
        """
        return resonances.largest_push(self)

    def resonances(self, factor: float = 1.0, orders: Sequence[int] = (3, 4)) -> tuple[Resonance, ...]:
        """Return the resonances near these spins, the one that needs the smallest push first.

        Parameters
        ----------
        factor : float, default 1.0
            The factor on all spins.
        orders : sequence, default (3, 4)
            The orders of the resonances.

        Returns
        -------
        tuple of Resonance
            It is empty if all modes have energies of one sign.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> nearest = example("corner").resonances(factor=0.83)[0]
        >>> nearest.order, round(nearest.factor, 4)
        (4, 0.8331)
        """
        return resonances.resonances(self, factor, orders)

    def characteristic(self) -> characteristic.Characteristic:
        """Derive the characteristic polynomial det(M s² + C s + K) in symbols, for at most 6 rotors.

        Returns
        -------
        Characteristic
            The factored polynomial, the matrices, and the numerical value of each symbol.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> example("top").characteristic().polynomial
        G_1**2*s**2 + a**2*s**4 - 2*a*kappa*s**2 + kappa**2
        """
        return characteristic.characteristic(self)

    def response(
        self, rates: ArrayLike, force: ArrayLike | None = None, at: int | None = None, ground: ArrayLike | None = None
    ) -> Complex:
        """Compute the complex amplitudes of the tips under harmonic forces or ground motion.

        Parameters
        ----------
        rates : array_like
            The angular frequencies (n,), rad/s.
        force : array_like or None, optional
            The amplitude in newtons: (x, y) on the tip `at`, or one row for each tip, shape (N, 2). It may be complex.
        at : int or None, optional
            The rotor whose tip bears the force.
        ground : array_like or None, optional
            The amplitude (x, y) of the acceleration of the ground, m/s².

        Returns
        -------
        Complex
            The displacements x, y of the tips relative to the ground, (n, N, 2), m.

        Examples
        --------
        >>> from lagrotor.structures import example
        >>> amplitudes = example("corner").response([0.5, 1.0], force=(1, 0), at=0)
        >>> amplitudes.shape, abs(amplitudes[1, 0, 0]).round(5).item()
        ((2, 3, 2), 0.08737)
        """
        return response.response(self, rates, force, at, ground)

    def plot(self) -> "Figure":
        """Draw the plan of the structure and the roots of its small motion.

        Returns
        -------
        Figure
            A figure that a notebook shows.
        """
        from lagrotor.structures.pictures import structure_picture

        return structure_picture(self)


_PARTS = {"rotor": Rotor, "link": Link, "braces": Brace}


def read_structure(path: str | Path) -> Structure:
    """Read a structure from a TOML file with the fields of `Structure`.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Structure
        The structure.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from lagrotor.structures import example
    >>> with TemporaryDirectory() as folder:
    ...     file = write_structure(example("top"), f"{folder}/top.toml")
    ...     read_structure(file) == example("top")
    True
    """
    return read_document(path, structure_of)


def structure_of(entries: dict[str, Any]) -> Structure:
    """Return the structure that a TOML table describes. Raises InputError unless each key is a field with a valid value."""
    check_fields(entries, Assembly, "a structure")
    if "joints" not in entries:
        raise InputError("joints is missing: give the ground joints, joints = [[0, 0], [1, 0]]")
    arguments = dict(entries)
    for name, kind in _PARTS.items():
        if name in entries:
            tables = entries[name] if isinstance(entries[name], list) else [entries[name]]
            arguments[name] = [part_of(name, kind, table) for table in tables]
    return Structure(**arguments)


def toml_of(s: Assembly) -> str:
    """Return the structure as TOML that `read_structure` reads."""
    lines = [
        f"{field.name} = {toml_value(getattr(s, field.name))}" for field in fields(Assembly) if field.name not in _PARTS
    ]
    for name in _PARTS:
        items = getattr(s, name)
        once = name != "braces" and len(set(items)) == 1
        for item in items[:1] if once else items:
            lines += ["", f"[{name}]" if once else f"[[{name}]]"]
            lines += [f"{key} = {toml_value(value)}" for key, value in asdict(item).items()]
    return "\n".join([*lines, ""])


def write_structure(s: Assembly, path: str | Path) -> Path:
    """Write a structure to a TOML file atomically.

    Parameters
    ----------
    s : Assembly
        The structure.
    path : str or Path
        The file, which ends in .toml.

    Returns
    -------
    Path
        The file that was written.
    """
    return write_text(path_of("write_structure: path", path), toml_of(s))
