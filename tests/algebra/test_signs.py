"""Signs do not depend on what was asked before."""

from itertools import permutations

import pytest
import sympy as sp

from lagrotor.algebra import signs
from lagrotor.algebra.signs import ANY, POSITIVE, Region, Signs, _Signs

a, b, c = sp.symbols("a b c", real=True)


class Circular(_Signs):
    """a rests on b, b on c, c on a; each is positive where what it rests on is open, and of any sign else."""

    def _sought(self, e: sp.Expr) -> Signs | None:
        return POSITIVE if self.of({a: b, b: c, c: a}[e]) is None else ANY


def test_no_answer_depends_on_the_order_of_asking() -> None:
    alone = {e: Circular(Region()).of(e) for e in (a, b, c)}
    for order in permutations((a, b, c)):
        asked = Circular(Region())
        assert {e: asked.of(e) for e in order} == alone


@pytest.mark.parametrize("strict", [True, False])
def test_nothing_that_is_asked_of_functions_and_roots_goes_round(strict: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    met: list[_Signs] = []
    made = _Signs.__init__
    monkeypatch.setattr(_Signs, "__init__", lambda self, where: (met.append(self), made(self, where))[1])
    signs._signs_in.cache_clear()
    where = signs.region([a > 0 if strict else a >= 0, b > 1])
    parts = (a, b - 1, a * b + 1, 1 - 1 / b)
    for f in (sp.sqrt, sp.log, sp.asin, sp.acosh, sp.sin, sp.tanh, sp.exp):
        for first, second in permutations(parts, 2):
            signs.signs(f(first) - f(second), where)
            signs.signs(sp.sqrt(f(first) + second) - first * f(second), where)
    assert met and not any(each.circles for each in met)
