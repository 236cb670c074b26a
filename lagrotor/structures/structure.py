"""`Structure`: any number of rotors and bars, and what can be found out about it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from lagrotor.pair.scene import Link, Rotor
from lagrotor.structures import (
    characteristic,
    critical_spins,
    leaning,
    precession_law,
    resonances,
    response,
    small_motion,
    standing,
    steady_precession,
)
from lagrotor.structures.assembly import Assembly, Brace
from lagrotor.structures.exact import structure_run
from lagrotor.structures.exact.closing import check_closure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Structure(Assembly):
    """Structure(joints, bars, spins, rotor, link, gravity, load, friction, hinge, braces): see `Assembly`.

    Examples:
        >>> from lagrotor.structures import example
        >>> corner = example("corner")
        >>> len(corner.joints), len(corner.bars)
        (3, 2)

    Raises:
        InputError: bars that cannot close, a bar to itself, dependent constraints, no degree of freedom left, loads below zero.
    """

    if TYPE_CHECKING:  # what may be given, which the fields then hold as tuples

        def __init__(
            self,
            joints: Sequence[Sequence[float]],
            bars: Sequence[Sequence[float]] = (),
            spins: float | Sequence[float] = 0.0,
            rotor: Rotor | Sequence[Rotor] = ...,
            link: Link | Sequence[Link] = ...,
            gravity: float = 0.0,
            load: float | Sequence[float] = 0.0,
            friction: float | Sequence[float] = 0.0,
            hinge: float | Sequence[float] = 0.0,
            braces: Sequence[Brace | Sequence[Any]] = (),
            spin_friction: float | Sequence[float] = 0.0,
        ) -> None: ...

    def __post_init__(self) -> None:
        super().__post_init__()
        check_closure(self)

    simulate = structure_run.simulate_structure
    modes = small_motion.modes
    rest_near = leaning.rest_near
    modes_about = leaning.modes_about
    steady_precession = steady_precession.steady_precession
    precession_law = precession_law.precession_law
    stands = standing.stands
    critical_spin = critical_spins.critical_spin
    spin_intervals = resonances.spin_intervals
    largest_push = resonances.largest_push
    resonances = resonances.resonances
    characteristic = characteristic.characteristic
    response = response.response

    def plot(self) -> "Figure":
        """The plan of the structure and the roots of its small motion: a figure that a notebook shows."""
        from lagrotor.structures.pictures import structure_picture

        return structure_picture(self)
