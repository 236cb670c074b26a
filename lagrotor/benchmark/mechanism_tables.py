"""Tables of the measurements on mechanisms, and of the targets with the measured values."""

from collections.abc import Sequence
from typing import Any

from lagrotor.benchmark.records import LINKS, MECHANISM_ERROR, Decided, Measured, MechanismKind
from lagrotor.result_display import scientific

_Row = tuple[str, ...]
_RUN, _DIFF = f"run to {scientific(MECHANISM_ERROR)} rad (ms)", "rhs differs by"
MECHANISM_HEAD = ("mechanism", "tool", "ready (ms)", "rhs (µs)", _RUN, "by", _DIFF)
DECISION_HEAD = ("two formulations", "same_as (ms)", "they agree", "simplify (ms)", "they agree", "times")
COMPARISON_HEAD = ("mechanism", "from", "ready (ms)", "sympy (ms)", "times", "rhs (µs)", "sympy (µs)", "times", _DIFF)
TARGET_HEAD = ("what", "wanted", "measured")
_AT: dict[MechanismKind, int] = {"rods": 6, "gyroscopes": 3}
_OURS, _METHODS = "lagrotor, bodies", ("KanesMethod", "LagrangesMethod")
_AGREE = {"zero": "yes", "nonzero": "no"}  # the difference of two formulations → they agree


def mechanism_name(kind: MechanismKind, n: int) -> str:
    """Return the name of a mechanism with n links, for example "24 rods" or "1 gyroscope"."""
    return f"{n} {kind if n > 1 else kind.removesuffix('s')}"


def mechanism_rows(measured: Sequence[Measured]) -> list[_Row]:
    """Return one row for each tool and mechanism; if a tool was not run, its row says why."""
    return [
        (
            mechanism_name(x.kind, x.n),
            x.tool,
            *map(_number, (x.ready, x.rhs, x.run), (1e3, 1e6, 1e3)),
            x.reason or _by(x),
            _off(x.difference),
        )
        for x in sorted(measured, key=lambda x: (list(LINKS).index(x.kind), x.n))
    ]


def comparison_rows(rows: Sequence[dict[str, Any]], longest: float) -> list[_Row]:
    """Return one row for each mechanism and source of its equations, compared with sympy's method. The processor time of sympy
    was limited to `longest` seconds."""
    table, by_tool = list[_Row](), {(row["mechanism"], row["tool"]): row for row in rows}
    for name in dict.fromkeys(row["mechanism"] for row in rows):
        for source, method in zip(("bodies", "Lagrangian"), _METHODS, strict=True):
            ours, theirs = by_tool[name, f"lagrotor, {source}"], by_tool[name, method]
            reason = theirs["reason"]
            least = f"over {longest / ours['ready']:.0f}" if reason and ours["ready"] else "—"
            table.append(
                (
                    name,
                    source,
                    ours["reason"] or _number(ours["ready"], 1e3),
                    reason or _number(theirs["ready"], 1e3),
                    least if reason else _ratio(theirs["ready"], ours["ready"]),
                    _number(ours["rhs"], 1e6),
                    _number(theirs["rhs"], 1e6),
                    _ratio(theirs["rhs"], ours["rhs"]),
                    " and ".join(
                        dict.fromkeys(_off(x["difference"]) for x in (ours, theirs) if x["difference"] is not None)
                    ),
                )
            )
    return table


def decision_rows(decided: Sequence[Decided]) -> list[_Row]:
    rows = list[_Row]()
    for x in decided:
        ours, theirs = (_AGREE.get(answer, answer) for answer in (x.answer, x.their_answer))
        times = f"{_at_least(x)}{x.times:.0f}"
        rows.append((x.pair, _number(x.ours, 1e3), ours, _number(x.theirs, 1e3), theirs, times))
    return rows


def target_rows(
    measured: Sequence[Measured],
    decided: Sequence[Decided],
    operations: dict[MechanismKind, list[int]],
    records: Sequence[dict[str, Any]],
) -> list[_Row]:
    """Return the targets with the measured values; — stands for a tool that was not measured.

    `operations` are the numbers of operations of one evaluation, for each size in LINKS. `records` are the rows of the record
    of bodies and Lagrangians.
    """
    by_tool = {(x.kind, x.n, x.tool): x for x in measured}
    recorded, none = {(x["mechanism"], x["tool"]): x for x in records}, {"ready": None, "rhs": None}
    table, nothing = list[_Row](), Measured("rods", 0, "")
    for kind, n in _AT.items():
        where = f"{n} {kind}"
        fast, pydy = (by_tool.get((kind, n, name), nothing) for name in ("lagrotor, fast", "PyDy, Cython"))
        ours, *others = (recorded.get((where, name), none) for name in (_OURS, *_METHODS))
        ready, rhs = (_least([x[what] for x in others]) for what in ("ready", "rhs"))
        table += [
            (f"ready, {where}, over the faster of Kane's and Lagrange's method", "15", _ratio(ready, ours["ready"])),
            (f"right-hand side, {where}, over lambdify of the best of them", "4", _ratio(rhs, ours["rhs"])),
            (f"right-hand side with the fast extra, {where}, over PyDy", "3", _ratio(pydy.rhs, fast.rhs)),
        ]
    for kind, numbers in LINKS.items():
        ready_in = [recorded.get((mechanism_name(kind, n), _OURS), none)["ready"] for n in numbers]
        for what, values in (("operations", operations[kind]), ("time to be ready", ready_in)):
            steps = zip(numbers, numbers[1:], values, values[1:], strict=False)
            doubled = [f"{b / a:.2f}" if a and b else "—" for m, n, a, b in steps if n == 2 * m]
            head = f"{what}, twice the {kind}, from {numbers[-len(doubled) - 1]}"
            table.append((head, "at most 2.3", ", ".join(doubled)))
    for what, answer in (("agree", "zero"), ("differ", "nonzero")):
        if pairs := [x for x in decided if x.answer == answer]:
            least = min(pairs, key=lambda x: x.times)
            ratio = f"{_at_least(least)}{least.times:.0f}"
            table.append((f"deciding that two formulations {what}, over simplify ({least.pair})", "20", ratio))
    return table


def _least(values: Sequence[float | None]) -> float | None:
    return min((v for v in values if v), default=None)


def _ratio(theirs: float | None, ours: float | None) -> str:
    return f"{theirs / ours:.1f}" if theirs and ours else "—"


def _number(value: float | None, unit: float) -> str:
    return "—" if value is None else f"{float(f'{value * unit:.3g}'):g}"


def _off(difference: float | None) -> str:
    return "—" if difference is None else scientific(difference)


def _by(x: Measured) -> str:
    name, _, tolerance = x.by.partition(" at ")
    return f"{name} at {scientific(float(tolerance)) if 'e' in tolerance else tolerance}" if tolerance else name


def _at_least(x: Decided) -> str:
    return "" if x.their_answer in _AGREE else "over "
