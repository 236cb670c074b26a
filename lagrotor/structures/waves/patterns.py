"""Named patterns with bars of one metre: rows, zigzags, rings, honeycomb, square, squares with octagons."""

from math import cos, pi, sin, sqrt
from typing import Any

from numpy.typing import ArrayLike

from lagrotor.errors import InputError
from lagrotor.pair.quantities import finite_number
from lagrotor.structures.coefficients import Array
from lagrotor.structures.waves import chern, dispersion, nonlinear_waves
from lagrotor.structures.waves.cell import Cell


class Pattern(Cell):
    """A cell of N rotors that repeats along one or two steps.

    A single number, rotor or link applies to all joints or bars. Units are SI. With a turn, each cell is the previous one moved
    by the step and turned about its origin: a ring that closes after 2π/turn cells.

    Attributes
    ----------
    joints : tuple
        The ground joints (x, y) of the cell, m.
    steps : tuple
        One or two steps (x, y), m.
    bars : tuple
        Bars (i, j) in the cell, or (i, j, shift) to joint j of the cell `shift` steps away, one integer per step.
    spins : tuple
        The spins of the joints, rad/s.
    turn : float
        The rotation of each cell against the previous one, rad.
    rotor : tuple
        The `Rotor` of each joint.
    link : tuple
        The `Link` of each bar.
    gravity : float
        The acceleration of gravity along −z, m/s².
    load : tuple
        The point mass on each tip, kg.
    friction : tuple
        The friction on the tilting rate of each axis, N m s/rad.
    hinge : tuple
        The stiffness of the spring that pulls each axis upright, N m/rad.
    braces : tuple
        Braces (i, j, shift, stiffness, damping), N/m and N s/m.
    inertia : bool
        False for the limit of fast spins, which has the slow precessions alone.

    Examples
    --------
    >>> from lagrotor import Pattern
    >>> row = Pattern([(0, 0)], steps=[(1, 0)], braces=[(0, 0, 1, 10.0)], spins=20.0, hinge=30.0)
    >>> row.dispersion([0.5]).rates.round(4).tolist()
    [[1.4318, 17.433]]
    """

    def long_wave_speeds(self, direction: ArrayLike = (1.0,)) -> Array:
        """Return the speeds dω/d|k| of long waves, q → 0, in the bands whose rate is proportional to q there.

        Parameters
        ----------
        direction : array_like, default (1.0,)
            The direction of the wave number q, (d,). The wave vector k in rad/m satisfies k . step = q.

        Returns
        -------
        Array
            The speeds, one for each such band, m/s. They are extrapolated from wave numbers of 10⁻³ rad per cell.

        Examples
        --------
        >>> from lagrotor.structures import straight_row
        >>> straight_row(spring=10.0).long_wave_speeds().round(4).tolist()
        [2.8284]
        """
        return dispersion.long_wave_speeds(self, direction)

    def dispersion(self, q: ArrayLike) -> dispersion.Dispersion:
        """Compute the bands at some wave numbers.

        Bars are rigid constraints. A brace of high stiffness represents a bar that stretches.

        Parameters
        ----------
        q : array_like
            The wave numbers, (n_q,) for one step or (n_q, d) for d steps, rad per cell.

        Returns
        -------
        Dispersion
            Rates, growths and shapes of the waves.

        Examples
        --------
        >>> from lagrotor.structures import honeycomb
        >>> honeycomb(spring=10.0, spins=20.0, hinge=30.0).dispersion([(0.1, 0.2)]).rates.shape
        (1, 4)
        """
        return dispersion.dispersion(self, q)

    def chern_numbers(self, grid: int = 24) -> chern.Chern:
        """Compute the Chern number of each group of bands.

        Its sign is the sign of the flux of i ⟨u|∇u⟩ with the sense from x to y as positive, whatever the order of the steps.

        Parameters
        ----------
        grid : int, default 24
            The number of wave numbers along each step.

        Returns
        -------
        Chern
            The groups of bands and their numbers.

        Raises
        ------
        InputError
            If the pattern has one step or friction, a wave grows or has the rate zero, or the number of bands varies with q.

        Examples
        --------
        >>> from lagrotor.structures import honeycomb
        >>> honeycomb(spring=10.0, spins=20.0, gravity=9.81, hinge=30.0).chern_numbers(grid=12).numbers
        (-1, 1, -1, 1)
        """
        return chern.chern_numbers(self, grid)

    def edge_waves(self, rate: float, width: int = 16, points: int = 181) -> chern.EdgeWaves:
        """Count the waves along the borders of a strip of a plane pattern, at a rate in a band gap of the whole pattern.

        Parameters
        ----------
        rate : float
            The rate, rad/s.
        width : int, default 16
            The number of cells across the strip.
        points : int, default 181
            The number of wave numbers.

        Returns
        -------
        EdgeWaves
            At each border, the number of waves along the first step minus the number against it.
        """
        return chern.edge_waves(self, rate, width, points)

    def nonlinear_wave(self, q: ArrayLike, band: int) -> nonlinear_waves.NonlinearWave:
        """Expand a wave through second order and its rate through third order in the amplitude.

        Parameters
        ----------
        q : array_like
            The wave number (d,), rad per cell.
        band : int
            The number of the band at q in `dispersion`, from 0. The number −1 − k means band k at −q, if it has a negative
            rate there.

        Returns
        -------
        NonlinearWave
            The wave, its mean and second harmonic, and the shift of its rate.

        Raises
        ------
        InputError
            With friction, for a wave that grows or has no rate, or at a resonance with its mean or second harmonic.

        Examples
        --------
        >>> from lagrotor.structures import straight_row
        >>> wave = straight_row(spring=10.0, spins=20.0, hinge=30.0).nonlinear_wave(0.5, band=0)
        >>> round(wave.rate, 4), round(wave.shift, 4)
        (1.4318, 0.2307)
        """
        return nonlinear_waves.nonlinear_wave(self, q, band)

    def three_waves(self, q: float) -> tuple[nonlinear_waves.ThreeWaves, ...]:
        """Find the triads of waves with q + q₂ = q₃ and ω + ω₂ = ω₃, in a pattern with one step.

        Growing waves are omitted. The search finds changes of the sign of ω + ω₂ − ω₃ between 181 values of q₂, so that double
        roots are missed.

        Parameters
        ----------
        q : float
            The wave number of the first wave, rad per cell.

        Returns
        -------
        tuple of ThreeWaves
            The triads, with bands numbered as in `nonlinear_wave`.
        """
        return nonlinear_waves.three_waves(self, q)


def straight_row(spring: float | None = None, **settings: Any) -> Pattern:
    """Return a row of rotors with equal distances.

    Parameters
    ----------
    spring : float or None, optional
        The stiffness of braces that replace the bars, N/m.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    return _joined(((0, 0),), ((1, 0),), ((0, 0, 1),), spring, settings)


def zigzag(angle: float, **settings: Any) -> Pattern:
    """Return a zigzag row with two rotors per cell.

    Parameters
    ----------
    angle : float
        The angle by which each bar turns against the previous one, alternately ±, rad. π/2 is a staircase.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    x, y = cos(angle / 2), sin(angle / 2)
    return Pattern(joints=((0, 0), (x, y)), steps=((2 * x, 0),), bars=((0, 1), (1, 0, 1)), **settings)


def polygon_ring(count: int, spring: float | None = None, **settings: Any) -> Pattern:
    """Return a ring of rotors with one rotor per cell; `piece(count)` closes it.

    Parameters
    ----------
    count : int
        The number of rotors in the ring, 3 or more.
    spring : float or None, optional
        The stiffness of braces that replace the bars, N/m.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    if count < 3:
        raise InputError(f"polygon_ring: {count} rotors are no polygon: give 3 or more")
    return _joined(((0, 0),), ((1, 0),), ((0, 0, 1),), spring, settings | {"turn": 2 * pi / count})


def honeycomb(spring: float | None = None, angle: float = 2 * pi / 3, **settings: Any) -> Pattern:
    """Return a honeycomb with two rotors per cell.

    Parameters
    ----------
    spring : float or None, optional
        The stiffness of braces that replace the bars, N/m.
    angle : float, default 2π/3
        The angle of two bars of a joint to the third bar, rad. π/2 gives the pattern of bricks, a smaller angle bow ties.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    angle = finite_number(angle, "honeycomb: angle", "rad")
    joins, (x, y) = ((0, 1, (0, 0)), (0, 1, (-1, 0)), (0, 1, (0, -1))), (sin(angle), 1 - cos(angle))
    return _joined(((0, 0), (0, 1)), ((x, y), (-x, y)), joins, spring, settings)


def square(spring: float | None = None, **settings: Any) -> Pattern:
    """Return a square lattice with one rotor per cell.

    Parameters
    ----------
    spring : float or None, optional
        The stiffness of braces that replace the bars, N/m.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    return _joined(((0, 0),), ((1, 0), (0, 1)), ((0, 0, (1, 0)), (0, 0, (0, 1))), spring, settings)


def square_octagon(move: tuple[float, float] = (0.0, 0.0), **settings: Any) -> Pattern:
    """Return a lattice of squares and octagons, with four rotors per cell.

    Parameters
    ----------
    move : tuple, default (0.0, 0.0)
        The displacement (x, y) of the first joint of each cell, m.
    **settings : dict
        Further fields of `Pattern`.

    Returns
    -------
    Pattern
        The pattern.
    """
    r, step = sqrt(0.5), 1 + sqrt(2)
    joints = ((r + move[0], move[1]), (0, r), (-r, 0), (0, -r))
    bars = ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2, (1, 0)), (1, 3, (0, 1)))
    return Pattern(joints, ((step, 0), (0, step)), bars=bars, **settings)


def _joined(joints: Any, steps: Any, joins: Any, spring: float | None, settings: dict[str, Any]) -> Pattern:
    if spring is None:
        return Pattern(joints, steps, bars=joins, **settings)
    return Pattern(joints, steps, braces=tuple((*join, spring) for join in joins), **settings)
