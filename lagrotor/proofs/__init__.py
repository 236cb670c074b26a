"""Computer-assisted proofs about motions, and Coq certificates of verdicts.

**Theorems** are about every motion that starts in a given set: its state at a time (`enclose`), a zero crossing of an
expression (`crossing`, `no_crossing`), its mean (`means`), a periodic orbit and its stability (`periodic_orbit`;
`precession` for the pair), an equilibrium (`equilibrium`). Numbers are balls (midpoint, radius) of Arb, rounded outward. A
decimal denotes the rational number that it prints. `NotProved` means that the proof failed; the statement may still be
true.

**Proofs.** Data pass through these modules in order:

1. `fields`: a `System`, `Scene`, `Structure` or `Program` becomes a `Field`, a motion x' = f(x) with its initial set and subject.
2. `tape`: f is a tape of elementary operations with exact constants.
3. `truncated_series`, `taylor_step`: one step is a Taylor model. A Picard inclusion proves its remainder bound.
4. `lohner_frames`: Lohner frames join the steps and limit the wrapping effect.
5. `orbits/enclosure`, `orbits/crossings`: states, signs and means along the steps.
6. `matrices`, `orbits/closed_orbits`, `orbits/equilibria`: Newton's method approximates an orbit or an equilibrium, and the
   Krawczyk test proves that it exists and is unique in a box. Enclosed Floquet multipliers or eigenvalues give the stability.
   `orbits/paired_orbits` does so for the pair, over a quarter of a period.

**Checker.** Each result has a `certificate`: plain data with subject, tape, initial set, steps and claim. `check` verifies
it without any search, with its own series, bounds and derivatives. It shares the table of operations, the generated
equations of scenes and structures, and the sentences of `statements`. An identity modulo a 512-bit prime proves that the
tape belongs to the subject. Each set must contain the image of the previous one, and the claim must follow. This second
implementation is deliberate.

**Coq certificates** are about printed equations. `coq/certificate` turns a verdict of `lagrotor.paper` into theorems over
the reals. `coq/equality_steps` writes both sides in generators: cosines and sines of base angles, exponentials, roots.
Their difference is a sum of cofactors times relations (`coq/cofactors`), which Coq multiplies out. `coq/points` finds a
rational counterexample to a refuted line, `coq/remainders` the remainder of a series. `coq/coq_check` writes the files and
runs Coq.

**Extensions.** A new operation needs a row in `tape.OPERATIONS`, its series in `truncated_series`, and separate ones in
`checker/tapes` and `checker/bounded_series`. A new kind of theorem needs a claim in its certificate, a rule in
`checker/checking` and a sentence in `statements`. Only claims, `lagrotor certify` and the report import this package.
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
