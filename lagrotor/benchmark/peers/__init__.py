"""Other tools on the same pair, each set up as its own documentation would have it; skipped with a word when absent.

They take scenes without shock and without mass in the bar.
"""

from lagrotor.benchmark.peers.multibody_engines import BODIES
from lagrotor.benchmark.peers.sundials import SUNDIALS
from lagrotor.benchmark.peers.sympy_mechanics import SYMPY
from lagrotor.benchmark.runner import Method

PEERS: dict[str, Method] = SYMPY | SUNDIALS | BODIES
