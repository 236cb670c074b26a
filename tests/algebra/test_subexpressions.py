"""Parts of expressions that are equal are the same object, whatever sympy has forgotten."""

import os
import subprocess
import sys

import sympy as sp
from sympy.core.cache import clear_cache

from lagrotor.algebra.subexpressions import with_shared_parts

x, y = sp.symbols("x y")


def nested(n: int) -> sp.Expr:
    """Each part twice in the next."""
    e = x
    for i in range(n):
        e = sp.sin(e + i) * y + sp.cos(e + i)
    return e


def test_equal_expressions_become_one() -> None:
    first = with_shared_parts(nested(30))
    clear_cache()
    second = nested(30)
    assert second is not first  # the twin
    assert with_shared_parts(second) is first
    third = with_shared_parts(second + 1)
    assert first in third.args or any(a is b for a in third.args for b in first.args)


def test_what_was_not_evaluated_stays_so() -> None:
    for _ in range(2):
        e = sp.Mul(2, x + y, evaluate=False)
        assert str(with_shared_parts(e)) == "2*(x + y)"
        assert with_shared_parts(sp.Float(2.0) * x) == 2.0 * x != with_shared_parts(2 * x)
        assert with_shared_parts(sp.Piecewise((x, x > 0), (1, True))) == sp.Piecewise((x, x > 0), (1, True))
        clear_cache()


COUNTED = """
import numpy as np
from sympy.core.basic import Basic
from benchmarks.mechanisms.chains import VALUES, chain
from lagrotor.algebra.subexpressions import forget
from lagrotor.mechanics import expressions
from lagrotor.mechanics.bodies import moving_frames

count, own = [0], Basic.__eq__

def counted(self, other):
    count[0] += 1
    return own(self, other)

Basic.__eq__ = counted

def twice():
    counts, rates = [], []
    forget()
    for _ in range(2):
        count[0] = 0
        rates.append(chain("rods", 12).rhs(VALUES)(0.0, np.linspace(0, 1, 24)))
        counts.append(count[0])
    assert np.array_equal(*rates)
    return counts

print(*twice())
expressions.with_shared_parts = moving_frames.with_shared_parts = lambda e: e
print(*twice())
"""


def test_equal_parts_of_a_chain_are_shared_and_not_compared_part_by_part() -> None:
    """In a process where sympy remembers what it does by itself, which is less than in these tests."""
    environment = os.environ | {"SYMPY_CACHE_SIZE": "1000"}
    run = subprocess.run([sys.executable, "-c", COUNTED], capture_output=True, text=True, env=environment, check=True)
    (first, second), (twin_first, twin_second) = (map(int, line.split()) for line in run.stdout.splitlines())
    assert 2 * first < twin_first and second < twin_second
