"""The tapes of a certificate, and Taylor terms by recurrences: the k-th term of an operation from the earlier ones.

Operations that no output needs are evaluated along the motion like all others; they say nothing of the subject.
"""

import re
from collections.abc import Callable, Sequence
from operator import mul
from typing import Any, TypeVar

from flint import arb, fmpz

from lagrotor.errors import InputError, NotProved
from lagrotor.proofs.tape import OPERATIONS

Term = Any
ZERO = arb(0)
Tape = dict[str, Any]
Value = TypeVar("Value")
_NAME = re.compile(r"[^\s=,;:<>\[\]!?\"#]+")  # one word
_NUMBER = re.compile(r"pi|-?\d+(/\d+)?", re.ASCII)


def demand(holds: bool, what: str) -> None:
    """Raise NotProved with a message unless a condition holds."""
    if not holds:
        raise NotProved(f"check: {what}")


def is_place(x: Any, end: int) -> bool:
    """Return True if x is a whole number from 0 to end − 1."""
    return type(x) is int and 0 <= x < end


def is_name(x: Any) -> bool:
    """Return True if x is one printable word without the punctuation of a sentence, such as commas and colons."""
    return type(x) is str and x.isprintable() and _NAME.fullmatch(x) is not None


def read_tape(data: Any) -> Tape:
    """Return the arguments, operations and outputs of a tape. Raises NotProved if one of them is malformed."""
    arguments, operations, outputs = (list(data[name]) for name in ("arguments", "operations", "outputs"))
    demand(all(map(is_name, arguments)), "an argument has no name")
    demand(len({*arguments}) == len(arguments), "two arguments have one name")
    for place, (name, *on) in enumerate(operations):
        if name == "argument":
            fine = len(on) == 1 and is_place(on[0], len(arguments))
        elif name == "number":
            fine = len(on) == 1 and type(on[0]) is str and _NUMBER.fullmatch(on[0]) is not None
        else:
            fine = OPERATIONS.get(name) == len(on) and all(is_place(x, place) for x in on)
        demand(fine, f"operation {place} of a tape is malformed: {str([name, *on])[:60]}")
    demand(all(is_place(x, len(operations)) for x in outputs), "an output of a tape is not the result of an operation")
    return {"arguments": arguments, "operations": operations, "outputs": outputs}


def results_of(
    tape: Tape, argument: Callable[[int], Value], number: Callable[[str], Value], operation: Callable[..., Value]
) -> list[Value]:
    """Evaluate a tape in some arithmetic, and return the results of all operations.

    The three functions evaluate an argument from its place, a number from its text, and an operation from its name and
    operands.
    """
    results: list[Value] = []
    for name, *on in tape["operations"]:
        if name == "argument":
            results.append(argument(on[0]))
        elif name == "number":
            results.append(number(on[0]))
        else:
            results.append(operation(name, *(results[place] for place in on)))
    return results


def demand_pace(tape: Tape) -> None:
    """Verify that each rate is a result times the pace, an argument that follows the states and occurs nowhere else."""
    rates, operations = {*tape["outputs"]}, tape["operations"]
    pace = {place for place, operation in enumerate(operations) if operation == ["argument", len(tape["outputs"])]}
    for place, (name, *on) in enumerate(operations):
        by_pace = sum(x in pace for x in on) if name in OPERATIONS else 0
        fine = name == "multiply" and by_pace == 1 if place in rates else not by_pace
        demand(fine and not (name in OPERATIONS and rates & {*on}), "the rates are not multiples of the pace")


def rational_of(text: str) -> Term:
    if text == "pi":
        return arb.pi()
    above, _, below = text.partition("/")
    return arb(fmpz(int(above))) / arb(fmpz(int(below or 1)))


def slopes_of(a: list[Term]) -> list[Term]:
    return [k * x for k, x in enumerate(a)][1:]


def taylor_term(name: str, a: list[Term], b: list[Term], q: list[Term], twin: list[Term], k: int) -> Term:
    """Return the k-th Taylor term of an operation on a (and b) from the earlier terms q.

    `twin` has the terms of a second function: cosine for sine, sine for cosine, √(1 − a²) for asin, 1 + a² for atan. Each call
    appends one term to it.
    """
    if name == "add":
        return a[k] + b[k]
    if name == "subtract":
        return a[k] - b[k]
    if name == "multiply":
        return convolution(a, b, 0, k)
    if name == "divide":
        return (a[k] - convolution(q, b, 0, k - 1, k)) / b[0]
    if name == "sqrt":
        return (a[k] - convolution(q, q, 1, k - 1, k)) / (2 * q[0]) if k else a[0].sqrt()
    rising = slopes_of(a[: k + 1])  # j a_j, from j = 1 on
    if name == "exp":
        return convolution(rising, q, 0, k - 1) / k if k else a[0].exp()
    if name == "log":
        return (a[k] - convolution(slopes_of(q), a, 0, k - 2, k - 1) / k) / a[0] if k else a[0].log()
    if name in ("sin", "cos"):
        sign = 1 if name == "sin" else -1
        if k:
            new = sign * convolution(rising, twin, 0, k - 1) / k
            twin.append(-sign * convolution(rising, q, 0, k - 1) / k)
            return new
        twin.append(a[0].cos() if name == "sin" else a[0].sin())
        return getattr(a[0], name)()
    if name not in ("asin", "atan"):
        raise InputError(f"check: the operation {name!r} is unknown")
    square = int(k == 0) + (1 if name == "atan" else -1) * convolution(a, a, 0, k)
    if name == "atan":
        twin.append(square)
    else:
        twin.append((square - convolution(twin, twin, 1, k - 1, k)) / (2 * twin[0]) if k else square.sqrt())
    return (a[k] - convolution(slopes_of(q), twin, 0, k - 2, k - 1) / k) / twin[0] if k else getattr(a[0], name)()


def convolution(a: list[Term], b: list[Term], first: int, last: int, k: int | None = None) -> Term:
    """Return Σ a_j b_(k−j) for j from first to last; k is `last` by default."""
    k = last if k is None else k
    return sum(map(mul, a[first : last + 1], b[k - last : k - first + 1][::-1]), ZERO) if last >= first else ZERO


def terms_of(name: str, a: list[Term], n: int) -> tuple[list[Term], list[Term]]:
    """Return n terms of a function of a series a, and n terms of the twin that `taylor_term` uses for the function."""
    terms, twin, full = list[Term](), list[Term](), a + [ZERO] * (n - len(a))
    unit = [arb(1)] + [ZERO] * (n - 1)
    for k in range(n):
        first, second = (unit, full) if name == "divide" else (full, full)
        terms.append(taylor_term(name, first, second, terms, twin, k))
    return terms, twin


def motion_terms(tape: Any, start: Sequence[Term], still: Sequence[Term], h: Term, n: int) -> list[list[Term]]:
    """Return n terms in s = t/h of each state; `still` has the values of the arguments that are constant."""
    rows = [[x] for x in start]
    operations = tape["operations"]
    terms: list[list[Term]] = [[] for _ in operations]
    twins: list[list[Term]] = [[] for _ in operations]
    for k in range(n - 1):
        for place, (name, *on) in enumerate(operations):
            if name == "argument":
                new = rows[on[0]][k] if on[0] < len(rows) else ZERO if k else still[on[0] - len(rows)]
            elif name == "number":
                new = ZERO if k else rational_of(on[0])
            else:
                new = taylor_term(name, terms[on[0]], terms[on[-1]], terms[place], twins[place], k)
            terms[place].append(new)
        for row, place in zip(rows, tape["outputs"], strict=True):
            row.append(terms[place][k] * (h / (k + 1)))
    return rows
