"""The paper *Dynamics of Axially Coupled Rotor Pairs*, the default of `audit` and of the command line.

The prefix of a derivation's name tells its subject: s a section, c claims, m tables, t theory beyond the paper, p the table of
this theory, n structures of rotors, b speed against accuracy, g textbook systems.
"""

from pathlib import Path

from lagrotor.paper.papers import opened
from lagrotor.paper.scripts import beside

PAPER = opened(Path(__file__).parent.resolve(), beside("derivations").parent)

# `audit()["5.22"]`, `audit("5.22")`.
audit = PAPER.audit
