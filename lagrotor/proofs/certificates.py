"""Certificates: what a proof found, as plain data (JSON) that `check` verifies without the search.

An exact number is text, mantissa in base 16 and power of two: "3p-1" is 3/2. A ball is [midpoint, radius], a matrix a list of
rows. `about`: of what the theorem is; `motion`: the tape x' = f(x) with its parameters; `start`: x_0 and w; `steps`: of each
its length, terms and the node at its end.
"""

from collections.abc import Sequence
from typing import Any, Protocol

from lagrotor.proofs.balls import Ball, Matrix, as_text, exact
from lagrotor.proofs.carried_sets import CarriedStep, Node, Start
from lagrotor.proofs.statements import theorem_of
from lagrotor.proofs.stepping import Motion
from lagrotor.proofs.subjects import Subject
from lagrotor.proofs.tape import Tape
from lagrotor.shown import Shown

Certificate = dict[str, Any]
VERSION = 1


class Certified(Protocol):
    """What has a certificate, a field of its own or made when it is read."""

    @property
    def certificate(self) -> Certificate: ...


class Proved(Shown):
    """A result with a theorem, which its certificate has."""

    @property
    def theorem(self: Certified) -> str:
        """In words."""
        return theorem_of(self.certificate)


def ball_data(x: Ball) -> list[str]:
    """[midpoint, radius]."""
    return [as_text(exact(x)), as_text(x.rad())]


def balls_data(values: Sequence[Ball]) -> list[list[str]]:
    """A list of balls."""
    return [ball_data(x) for x in values]


def exact_data(values: Sequence[Ball]) -> list[str]:
    """A list of exact numbers."""
    return [as_text(x) for x in values]


def matrix_data(matrix: Matrix) -> list[Any]:
    """Rows of exact numbers."""
    return [exact_data(row) for row in matrix.tolist()]


def tape_data(tape: Tape) -> dict[str, Any]:
    """The operations of a tape."""
    return {
        "arguments": list(tape.arguments),
        "operations": [list(operation) for operation in tape.operations],
        "outputs": list(tape.outputs),
    }


def motion_data(motion: Motion) -> dict[str, Any]:
    """The tape and its parameters."""
    return tape_data(motion.tape) | {"parameters": balls_data(motion.parameters)}


def node_data(node: Node) -> dict[str, Any]:
    """m + Q s + (C + Q S) w."""
    return {
        "m": exact_data(node.m),
        "Q": matrix_data(node.Q),
        "s": balls_data(node.s),
        "C": matrix_data(node.C),
        "S": [balls_data(row) for row in node.S.tolist()],
    }


def step_data(step: CarriedStep) -> dict[str, Any]:
    """One step with the node at its end."""
    return {
        "h": ball_data(step.h),
        "terms": step.n,
        "slope_terms": step.slope_terms,
        "node": node_data(step.end),
    }


def flow_data(about: Subject, motion: Motion, start: Start, steps: Sequence[CarriedStep], bits: int) -> Certificate:
    """What all certificates of a motion have in common."""
    return {
        "version": VERSION,
        "bits": bits,
        "about": about,
        "motion": motion_data(motion),
        "start": {"middle": balls_data(start.middle), "spread": balls_data(start.spread)},
        "steps": [step_data(step) for step in steps],
    }
