"""Generated programs as heyoka's expressions and compiled functions."""

from collections.abc import Callable, Sequence
from functools import lru_cache, reduce
from operator import mul
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from lagrotor.errors import InputError
from lagrotor.numerics.codegen import Program, reduce_common

Array = NDArray[np.float64]


def heyoka_module() -> Any:
    try:
        import heyoka
    except ImportError:
        raise InputError("engine='fast' needs heyoka: pip install 'lagrotor[fast]', or use engine='core'") from None
    return heyoka


def summed(terms: Sequence[Any]) -> Any:
    """The sum of expressions and numbers."""
    heyoka = heyoka_module()
    return heyoka.sum([heyoka.expression(x) if isinstance(x, float) else x for x in terms])


def translated(program: Program, known: dict[sp.Symbol, Any], heyoka: Any) -> list[Any]:
    """The program's outputs as heyoka's expressions of what is `known`, its arguments."""
    stages, outputs = reduce_common(program)
    named = dict(known)
    for name, expression in stages:
        named[name] = _translate(expression, named, heyoka)
    return [_translate(e, named, heyoka) for e in outputs]


def _translate(e: sp.Expr, known: dict[sp.Symbol, Any], heyoka: Any) -> Any:
    if e in known:
        return known[e]
    if e.is_Number:
        return heyoka.expression(float(e))
    if e.is_Pow:
        base, power = _translate(e.base, known, heyoka), e.exp
        if power == sp.Rational(1, 2):
            return heyoka.sqrt(base)
        if not power.is_Integer:
            return base ** float(power)
        product = _product([base] * abs(int(power)))
        return product if power > 0 else 1.0 / product
    parts = [_translate(x, known, heyoka) for x in e.args]
    if e.is_Add:
        return heyoka.sum(parts)
    if e.is_Mul:
        return _product(parts)
    if not hasattr(heyoka, e.func.__name__):
        raise InputError(f"engine='fast' does not know the function {e.func.__name__}: use engine='core'")
    return getattr(heyoka, e.func.__name__)(*parts)


def _product(parts: Sequence[Any]) -> Any:
    return reduce(mul, parts)


def taylor_rhs(program: Program, states: int, parameters: tuple[float, ...]) -> Callable[[float, Array], Array]:
    """The program, for given parameters, as a compiled right-hand side (s, y) → y', for any solver."""
    compiled, inputs = _compiled(program), np.array([*[0.0] * states, *parameters])

    def rhs(s: float, y: Array) -> Array:
        inputs[:states] = y
        return np.asarray(compiled(inputs))

    return rhs


@lru_cache(maxsize=16)
def _compiled(program: Program) -> Any:
    """The program as heyoka's function of an array of its arguments."""
    heyoka = heyoka_module()
    known = {s: heyoka.make_vars(str(s)) for s in program.arguments}
    outputs = translated(program, known, heyoka)
    return heyoka.cfunc(outputs, [known[s] for s in program.arguments], fast_math=True)
