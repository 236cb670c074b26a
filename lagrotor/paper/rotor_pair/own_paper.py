"""The paper *Dynamics of Axially Coupled Rotor Pairs*: what `audit` and the command line take where no other is named.

Its derivations and figures lie beside the package: s… sections, c… claims, m… tables, t… theory past the paper, p… the table
of it, n… from the pair to structures, b… speed against accuracy, g… the gallery of textbook systems.
"""

from pathlib import Path

from lagrotor.paper.audit import Audit
from lagrotor.paper.ledger import Verdict
from lagrotor.paper.papers import Progress, opened
from lagrotor.paper.scripts import beside

PAPER = opened(Path(__file__).parent.resolve(), beside("derivations").parent)


def audit(identifier: str | None = None, progress: Progress | None = None) -> Audit | Verdict:
    """Judge every equation of the paper, or one, as `Paper.audit` does: `audit()["5.22"]`, `audit("5.22")`."""
    return PAPER.audit(identifier, progress)
