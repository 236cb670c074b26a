"""Other tools on the same pair, each set up as its own documentation recommends; skipped, with the reason, where not installed.

They take scenes without shock and without mass in the bar.
"""

from lagrotor.benchmark.method import Method
from lagrotor.benchmark.peers.multibody_engines import BODIES
from lagrotor.benchmark.peers.sundials import SUNDIALS
from lagrotor.benchmark.peers.sympy_mechanics import SYMPY

PEERS: dict[str, Method] = SYMPY | SUNDIALS | BODIES
