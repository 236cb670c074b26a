"""Claims about motion as theorems: validated integration on Arb's balls, and fixed-point theorems."""

from typing import TYPE_CHECKING

from lagrotor.faces import face

if TYPE_CHECKING:
    from lagrotor.errors import NotProved as NotProved
    from lagrotor.proofs.checker.checking import check as check
    from lagrotor.proofs.orbits.closed_orbits import PeriodicOrbit as PeriodicOrbit
    from lagrotor.proofs.orbits.closed_orbits import periodic_orbit as periodic_orbit
    from lagrotor.proofs.orbits.crossings import Crossing as Crossing
    from lagrotor.proofs.orbits.crossings import Means as Means
    from lagrotor.proofs.orbits.crossings import crossing as crossing
    from lagrotor.proofs.orbits.crossings import means as means
    from lagrotor.proofs.orbits.crossings import no_crossing as no_crossing
    from lagrotor.proofs.orbits.enclosure import Enclosure as Enclosure
    from lagrotor.proofs.orbits.enclosure import enclose as enclose
    from lagrotor.proofs.orbits.paired_orbits import Precession as Precession
    from lagrotor.proofs.orbits.paired_orbits import precession as precession
    from lagrotor.proofs.orbits.steady import ProvedEquilibrium as ProvedEquilibrium
    from lagrotor.proofs.orbits.steady import equilibrium as equilibrium

__getattr__, __dir__, __all__ = face(__name__)
