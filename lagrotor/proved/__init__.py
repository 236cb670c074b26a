"""Claims about motion as theorems: validated integration on Arb's balls, and fixed-point theorems."""

from typing import TYPE_CHECKING

from lagrotor.faces import face

if TYPE_CHECKING:
    from lagrotor.errors import NotProved as NotProved
    from lagrotor.proved.closed_orbits import PeriodicOrbit as PeriodicOrbit
    from lagrotor.proved.closed_orbits import periodic_orbit as periodic_orbit
    from lagrotor.proved.crossings import Crossing as Crossing
    from lagrotor.proved.crossings import Means as Means
    from lagrotor.proved.crossings import crossing as crossing
    from lagrotor.proved.crossings import means as means
    from lagrotor.proved.crossings import no_crossing as no_crossing
    from lagrotor.proved.enclosure import Enclosure as Enclosure
    from lagrotor.proved.enclosure import enclose as enclose
    from lagrotor.proved.paired_orbits import Precession as Precession
    from lagrotor.proved.paired_orbits import precession as precession
    from lagrotor.proved.steady import ProvedEquilibrium as ProvedEquilibrium
    from lagrotor.proved.steady import equilibrium as equilibrium
    from lagrotor.proved.verification.checking import check as check

__getattr__, __dir__, __all__ = face(__name__)
