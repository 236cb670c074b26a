"""Taylor terms by recurrences, for single motions and for families: the k-th term of an operation from those before it.

A term is a ball, or a truncated series of a parameter whose coefficients are balls.
"""

from collections.abc import Sequence
from operator import mul
from typing import Any

from flint import arb, fmpz

from lagrotor.errors import InputError, NotProved

Term = Any
ZERO = arb(0)


def demand(holds: bool, what: str) -> None:
    """Raises NotProved where something does not hold."""
    if not holds:
        raise NotProved(f"check: {what}")


def rational_of(text: str) -> Term:
    """A number of a tape."""
    if text == "pi":
        return arb.pi()
    above, _, below = text.partition("/")
    return arb(fmpz(int(above))) / arb(fmpz(int(below or 1)))


def slopes_of(a: list[Term]) -> list[Term]:
    """The derivative's terms."""
    return [k * x for k, x in enumerate(a)][1:]


def taylor_term(name: str, a: list[Term], b: list[Term], q: list[Term], twin: list[Term], k: int) -> Term:
    """The k-th term of an operation on a (and b), from its terms q before it. twin: terms of the cosine beside a sine or the
    sine beside a cosine, of √(1 − a²) beside an arcsine, of 1 + a² beside an arctangent, which are continued, too."""
    if name == "add":
        return a[k] + b[k]
    if name == "subtract":
        return a[k] - b[k]
    if name == "multiply":
        return folded(a, b, 0, k)
    if name == "divide":
        return (a[k] - folded(q, b, 0, k - 1, k)) / b[0]
    if name == "sqrt":
        return (a[k] - folded(q, q, 1, k - 1, k)) / (2 * q[0]) if k else a[0].sqrt()
    rising = slopes_of(a[: k + 1])  # j a_j, from j = 1 on
    if name == "exp":
        return folded(rising, q, 0, k - 1) / k if k else a[0].exp()
    if name == "log":
        return (a[k] - folded(slopes_of(q), a, 0, k - 2, k - 1) / k) / a[0] if k else a[0].log()
    if name in ("sin", "cos"):
        sign = 1 if name == "sin" else -1
        if k:
            new = sign * folded(rising, twin, 0, k - 1) / k
            twin.append(-sign * folded(rising, q, 0, k - 1) / k)
            return new
        twin.append(a[0].cos() if name == "sin" else a[0].sin())
        return getattr(a[0], name)()
    if name not in ("asin", "atan"):
        raise InputError(f"check: the operation {name!r} is unknown")
    square = int(k == 0) + (1 if name == "atan" else -1) * folded(a, a, 0, k)
    if name == "atan":
        twin.append(square)
    else:
        twin.append((square - folded(twin, twin, 1, k - 1, k)) / (2 * twin[0]) if k else square.sqrt())
    return (a[k] - folded(slopes_of(q), twin, 0, k - 2, k - 1) / k) / twin[0] if k else getattr(a[0], name)()


def folded(a: list[Term], b: list[Term], first: int, last: int, k: int | None = None) -> Term:
    """Σ a_j b_(k−j) for j from first to last; k is `last` unless it is another."""
    k = last if k is None else k
    return sum(map(mul, a[first : last + 1], b[k - last : k - first + 1][::-1]), ZERO) if last >= first else ZERO


def terms_of(name: str, a: list[Term], n: int) -> tuple[list[Term], list[Term]]:
    """n terms of a function of a series, and those of its twin."""
    found, twin, full = list[Term](), list[Term](), a + [ZERO] * (n - len(a))
    one = [arb(1)] + [ZERO] * (n - 1)
    for k in range(n):
        first, second = (one, full) if name == "divide" else (full, full)
        found.append(taylor_term(name, first, second, found, twin, k))
    return found, twin


def motion_terms(tape: Any, start: Sequence[Term], still: Sequence[Term], h: Term, n: int) -> list[list[Term]]:
    """n terms in s = t/h of what moves by the tape's rates; `still`: the arguments that do not."""
    rows = [[x] for x in start]
    operations = tape["operations"]
    found: list[list[Term]] = [[] for _ in operations]
    twins: list[list[Term]] = [[] for _ in operations]
    for k in range(n - 1):
        for place, (name, *on) in enumerate(operations):
            if name == "argument":
                new = rows[on[0]][k] if on[0] < len(rows) else ZERO if k else still[on[0] - len(rows)]
            elif name == "number":
                new = ZERO if k else rational_of(on[0])
            else:
                new = taylor_term(name, found[on[0]], found[on[-1]], found[place], twins[place], k)
            found[place].append(new)
        for row, place in zip(rows, tape["outputs"], strict=True):
            row.append(found[place][k] * (h / (k + 1)))
    return rows
