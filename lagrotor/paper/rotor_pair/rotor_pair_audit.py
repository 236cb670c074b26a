"""The paper *Dynamics of Axially Coupled Rotor Pairs*: what `audit` and the command line take where no other is named.

Its derivations and figures lie beside the package: s… sections, c… claims, m… tables, t… theory past the paper, p… the table
of it, n… from the pair to structures, b… speed against accuracy, g… the gallery of textbook systems.
"""

from pathlib import Path

from lagrotor.paper.papers import opened
from lagrotor.paper.scripts import beside

PAPER = opened(Path(__file__).parent.resolve(), beside("derivations").parent)

# `audit()["5.22"]`, `audit("5.22")`.
audit = PAPER.audit
