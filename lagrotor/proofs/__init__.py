"""Theorems about motions, and certificates of verdicts: both are checked by programs that did not make them.

**What a theorem is.** A statement about every motion that starts in a given set: where the motion is at a time (`enclose`), that
an expression passes zero before a time or does not (`crossing`, `no_crossing`), what its mean is (`means`), that a periodic orbit
exists and whether it is stable (`periodic_orbit`, `precession` of the pair), that an equilibrium exists (`equilibrium`). Numbers
are balls of Arb, a midpoint and a radius, rounded outward. A decimal means the rational number that it prints. A statement that
cannot be proved raises `NotProved`; it may still be true.

**How it is found.** Data pass through these modules in order:

1. `fields`: a `System`, `Scene`, `Structure` or `Program` becomes a `Field`, a motion x' = f(x) with its start, and the subject
   that the theorem names.
2. `tape`: f is a tape of elementary operations with exact constants.
3. `truncated_series`, `taylor_step`: one step is a Taylor polynomial with a bound of the rest (Picard's map takes a ball of
   series into itself) and with the derivative by the start.
4. `lohner_frames`: steps are joined in Lohner's frames, so that sets do not grow by wrapping.
5. `orbits/enclosure`, `orbits/crossings`: states, signs and means along the steps.
6. `matrices`, `orbits/closed_orbits`, `orbits/equilibria`: Newton's method finds an orbit or equilibrium, and Krawczyk's test
   proves that it exists and is alone nearby. Enclosed multipliers or eigenvalues give the stability. `orbits/paired_orbits`
   does so for the pair, from a quarter of a period.

**How it is checked.** Each result has a `certificate`, plain data: subject, tape, start, steps, claim. `check` in `checker/`
reads it and looks for nothing. It has its own series, bounds and derivatives. It takes only the table of
operations, the generated equations of scenes and structures, and the words of `statements` from here. It shows that the tape is
that of the subject (an identity modulo a prime of 512 bits), that each set holds the image of the one before, and that the claim
follows. It returns the theorem, composed from the claim that it verified. This second implementation is deliberate.

**How certificates in Coq are made.** They are about printed equations, not motions. `coq/certificate` turns a verdict of
`lagrotor.paper` into theorems over the reals. `coq/equality_steps` writes both sides in generators (cosines and sines of base
angles, exponentials, roots); their difference is a sum of cofactors times relations (`coq/cofactors`), which Coq multiplies
out. `coq/points` finds a rational point at which a refuted line fails, `coq/remainders` the remainder of a series, and
`coq/coq_check` writes a folder of files and lets Coq check them.

**How to extend it.** A new operation needs a row in `tape.OPERATIONS`, its series in `truncated_series` and a second, separate
one in `checker/tapes` and `checker/bounded_series`. A new kind of theorem needs a claim in its certificate, a rule in
`checker/checking` and words in `statements`. The package is a leaf: only claims, `lagrotor certify` and the report import it.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

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
    from lagrotor.proofs.orbits.equilibria import ProvedEquilibrium as ProvedEquilibrium
    from lagrotor.proofs.orbits.equilibria import equilibrium as equilibrium
    from lagrotor.proofs.orbits.paired_orbits import Precession as Precession
    from lagrotor.proofs.orbits.paired_orbits import precession as precession

__getattr__, __dir__, __all__ = face(__name__)
