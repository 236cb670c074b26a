"""Other tools on the same pair, each set up as its own documentation would have it; skipped with a word when absent.

They take scenes without shock and without mass in the bar.
"""

from ..method import Method
from .engines import BODIES
from .sundials import SUNDIALS
from .sympy_mechanics import SYMPY

PEERS: dict[str, Method] = SYMPY | SUNDIALS | BODIES
