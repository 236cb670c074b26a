"""A certificate's tapes, read: each operation is known and on earlier results; the rates of a motion in s = t/pace.

An operation that no output needs is followed along the motion as all others are; of what is named it says nothing.
"""

import re
from collections.abc import Callable
from typing import Any, TypeVar

from lagrotor.proofs.checker.recurrences import demand
from lagrotor.proofs.tape import OPERATIONS

Tape = dict[str, Any]
Value = TypeVar("Value")
_NAME = re.compile(r"[^\s=,;:<>\[\]!?\"#]+")  # in which nothing else can be said
_NUMBER = re.compile(r"pi|-?\d+(/\d+)?", re.ASCII)


def is_place(x: Any, end: int) -> bool:
    """Whether x is a whole number from 0 to end − 1."""
    return type(x) is int and 0 <= x < end


def is_name(x: Any) -> bool:
    """Whether x names one thing and says nothing else; all of it is seen."""
    return type(x) is str and x.isprintable() and _NAME.fullmatch(x) is not None


def read_tape(data: Any) -> Tape:
    """The arguments, operations and outputs of a tape. Raises NotProved where one of them is none."""
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
        demand(fine, f"operation {place} of a tape is none: {str([name, *on])[:60]}")
    demand(all(is_place(x, len(operations)) for x in outputs), "an output of a tape is no operation's")
    return {"arguments": arguments, "operations": operations, "outputs": outputs}


def results_of(
    tape: Tape, argument: Callable[[int], Value], number: Callable[[str], Value], operation: Callable[..., Value]
) -> list[Value]:
    """What each operation of a tape gives in an arithmetic: of an argument's place, of a number, of a name and operands."""
    found: list[Value] = []
    for name, *on in tape["operations"]:
        if name == "argument":
            found.append(argument(on[0]))
        elif name == "number":
            found.append(number(on[0]))
        else:
            found.append(operation(name, *(found[place] for place in on)))
    return found


def demand_paced(tape: Tape) -> None:
    """Each rate is an operation's result times the pace, the argument after the states, which enters nowhere else."""
    rates, operations = {*tape["outputs"]}, tape["operations"]
    pace = {place for place, operation in enumerate(operations) if operation == ["argument", len(tape["outputs"])]}
    for place, (name, *on) in enumerate(operations):
        by_pace = sum(x in pace for x in on) if name in OPERATIONS else 0
        fine = name == "multiply" and by_pace == 1 if place in rates else not by_pace
        demand(fine and not (name in OPERATIONS and rates & {*on}), "the motion is not one in units of its pace")
