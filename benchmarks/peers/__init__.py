"""Other tools on the same pair, each set up as its own documentation recommends; skipped, with the reason, where not installed.

They take scenes without shock and without mass in the bar.
"""

from benchmarks.peers.multibody_engines import BODIES
from benchmarks.peers.sundials import SUNDIALS
from benchmarks.peers.sympy_mechanics import SYMPY
from lagrotor.benchmark.runner import Method

PEERS: dict[str, Method] = SYMPY | SUNDIALS | BODIES
