"""Tests of claims that a paper makes in words: a simulation measures numbers, and a rule decides by these numbers alone.

A `ClaimTest` separates the simulation from the decision. For a case that contradicts the claim, the same rule must decide
otherwise. If a theorem encloses the motion, it decides in place of the simulation.
"""

import json
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

from lagrotor.errors import NotProved, ProofError
from lagrotor.paper.catalogue import Claim
from lagrotor.paper.tables import Table
from lagrotor.paper.theorems import Theorem, can_prove, verify
from lagrotor.result_display import Printed

Outcome = Literal["proved", "confirmed", "confirmed-if", "refuted"]


class PrintedNumber(float):
    """A number as printed. It stands for every number that rounds to it: up to half a unit of its last digit above or below."""

    def __init__(self, digits: str) -> None:
        self.digits, self.half_unit = digits, 0.5 / 10 ** len(digits.partition(".")[2])

    def is_matched(self, number: float) -> bool:
        """Return True if the number rounds to the printed one."""
        return abs(number - self) < self.half_unit

    @property
    def rule(self) -> str:
        """The interval of the numbers that the printed one stands for, in words."""
        return f"{self.digits} as printed means {self - self.half_unit:.8g} to {self + self.half_unit:.8g}"

    def compare(self, number: float) -> str:
        """Return in words whether a number rounds to the printed one, and by how many percent it differs."""
        rounds = "rounds" if self.is_matched(number) else "does not round"
        side = "above" if number > self else "below"
        return f"which {rounds} to {self.digits} and is {abs(number / self - 1):.1%} {side} it"


@dataclass(frozen=True)
class Part:
    """One part of a claim's sentence, and whether it holds.

    Attributes
    ----------
    says : str
        The part in words.
    holds : bool
        True if the numbers confirm the part without any condition.
    only_if : str, default ''
        For a part that does not hold in general, the condition under which it holds; empty if there is none.
    theorems : tuple[Theorem, ...], default ()
        The theorems that decide the part; without any, simulations decide.

    Examples
    --------
    >>> Part("the link length is constant", False, "the amplitude is small").outcome
    'holds only if: the amplitude is small'
    """

    says: str
    holds: bool
    only_if: str = ""
    theorems: tuple[Theorem, ...] = ()

    @property
    def outcome(self) -> str:
        """The decision on the part in words: 'holds', 'does not hold' or 'holds only if: …'."""
        if self.holds or not self.only_if:
            words = "holds" if self.holds else "does not hold"
            return f"{words}, proved" if self.theorems else words
        return f"holds only if: {self.only_if}{'; it is proved that it does not always hold' if self.theorems else ''}"


@dataclass(frozen=True)
class Finding(Printed):
    """The decision on a claim.

    A claim is refuted if a part holds under no condition, confirmed-if if a part needs a condition, proved if theorems
    decide every part, and confirmed otherwise.

    Attributes
    ----------
    parts : tuple[Part, ...]
        The parts of the sentence.
    explanation : str
        The reason for the decision, in sentences with the measured numbers.

    Examples
    --------
    >>> finding = Finding((Part("it swings", True), Part("harmonically", False, "the angle is small")), "")
    >>> finding.outcome, finding.condition
    ('confirmed-if', 'the angle is small')
    """

    _shown = (
        ("outcome", "outcome"),
        ("under the condition", "condition"),
        (
            "parts",
            lambda f: "\n".join(f"{part.says}: {'holds' if part.holds else 'does not hold'}" for part in f.parts),
        ),
        ("why", "explanation"),
    )

    parts: tuple[Part, ...]
    explanation: str

    @property
    def outcome(self) -> Outcome:
        """The decision on the whole claim: 'proved', 'confirmed', 'confirmed-if' or 'refuted'."""
        if any(not part.holds and not part.only_if for part in self.parts):
            return "refuted"
        if not all(part.holds for part in self.parts):
            return "confirmed-if"
        return "proved" if self.parts and all(part.theorems for part in self.parts) else "confirmed"

    @property
    def condition(self) -> str | None:
        """The conditions of the parts as one sentence; None unless the outcome is confirmed-if."""
        needed = dict.fromkeys(part.only_if for part in self.parts if not part.holds)
        return "; ".join(needed) if self.outcome == "confirmed-if" else None

    @property
    def theorems(self) -> tuple[tuple[Part, Theorem], ...]:
        """All pairs of a part and a theorem that decides it."""
        return tuple((part, theorem) for part in self.parts for theorem in part.theorems)

    def _with_theorems(self, proved: Iterable[Part], where: str) -> "Finding":
        """Add theorems to the parts that they decide; raise ProofError if one contradicts the simulation."""
        parts = {part.says: part for part in self.parts}
        for part in proved:
            if part.says not in parts or not part.theorems:
                wrong = "has no theorem" if part.says in parts else "is not a part of the claim"
                raise ProofError(f"{where}: {part.says!r} {wrong}")
            if part.holds != parts[part.says].holds:
                raise ProofError(
                    f"{where}: {part.says}: by the simulation it {parts[part.says].outcome}, by a theorem it {part.outcome}"
                )
            parts[part.says] = replace(parts[part.says], theorems=part.theorems)
        return replace(self, parts=tuple(parts.values()))


@dataclass(frozen=True)
class ClaimTest:
    """The test of one claim.

    Attributes
    ----------
    id : str
        The claim's id in `claims.toml`.
    case : Any
        The claim's own case, the argument of `measure`: parameters or initial values of the simulation.
    foreign : Mapping[str, Any]
        Part of the sentence → a case that contradicts it, so that the decision on this part must differ.
    model : str
        The simulated models, in words.
    measure : Callable
        Function of a case that simulates it and returns numbers by name.
    decide : Callable
        Function of these numbers that returns a `Finding`.
    prove : Callable or None, optional
        Function of a case that returns the parts that theorems decide, with these theorems.
    unproved : str, default ''
        The reason why no theorem decides the remaining parts.

    Examples
    --------
    >>> test = ClaimTest("C01", 0.994, {"it beats seconds": 0.5}, "pendulum", lambda l: {"period_s": 2.006 * l**0.5},
    ...     lambda m: Finding((Part("it beats seconds", abs(m["period_s"] - 2) < 0.01),), f"{m['period_s']:.3f} s."))
    >>> test.result.finding.outcome, test.evaluated(0.5).finding.outcome
    ('confirmed', 'refuted')
    """

    id: str
    case: Any
    foreign: Mapping[str, Any]
    model: str
    measure: Callable[[Any], Mapping[str, float]]
    decide: Callable[[Mapping[str, float]], Finding]
    prove: Callable[[Any], Iterable[Part]] | None = None
    unproved: str = ""

    def evaluated(self, case: Any) -> "Result":
        """Measure the numbers of a case and decide by them.

        Parameters
        ----------
        case : Any
            The argument of `measure`.

        Returns
        -------
        Result
            The measured numbers and the finding.

        Raises
        ------
        ProofError
            If a theorem contradicts the simulation or its certificate is rejected.
        """
        began = time.perf_counter()
        measured = self.measured if case is self.case else self._numbers(case)
        finding = self.decide(measured)
        if self.unproved:
            what = "the other parts" if self.prove else "the claim"
            why = f"No theorem decides {what}: {self.unproved}."
            finding = replace(finding, explanation=f"{finding.explanation} {why}")
        if self.prove is not None and can_prove():
            parts: list[Part] = []
            try:
                parts += self.prove(case)
            except NotProved as refusal:
                finding = replace(finding, explanation=f"{finding.explanation} The proof failed: {refusal}.")
            finding = finding._with_theorems(parts, self.id)
            verify({id(theorem): theorem for _, theorem in finding.theorems}.values(), self.id)
        return Result(self, measured, finding, time.perf_counter() - began)

    def _numbers(self, case: Any) -> dict[str, float]:
        return {name: float(value) for name, value in self.measure(case).items()}

    @cached_property
    def measured(self) -> dict[str, float]:
        """The numbers of the claim's own case. The first access runs the simulations, which take some seconds."""
        return self._numbers(self.case)

    @cached_property
    def result(self) -> "Result":
        """The result of the claim's own case. The first access proves its theorems, if python-flint is installed."""
        return self.evaluated(self.case)

    def _repr_html_(self) -> str:
        finding = self.result.finding
        rows = tuple((part.says, part.outcome) for part in finding.parts)
        return Table(self.id, ("part of the claim", finding.outcome), rows, finding.explanation)._repr_html_()


@dataclass(frozen=True)
class Result(Printed):
    """A claim after its test.

    Attributes
    ----------
    test : ClaimTest
        The test of the claim.
    measured : Mapping[str, float]
        The measured numbers by name; each name ends in the unit.
    finding : Finding
        The decision with its reasons.
    seconds : float
        Computing time in s.
    """

    _shown = (
        ("claim", lambda r: r.test.id),
        ("outcome", lambda r: r.finding.outcome),
        ("measured", "measured"),
        ("why", lambda r: r.finding.explanation),
    )

    test: ClaimTest
    measured: Mapping[str, float]
    finding: Finding
    seconds: float


def claim_data(result: Result, entry: Claim) -> dict[str, Any]:
    """Return one claim as the JSON object that `lagrotor claims --json` prints."""
    return {
        "id": entry.id,
        "section": entry.section,
        "text": entry.text,
        "verdict": result.finding.outcome,
        "condition": result.finding.condition,
        "parts": [
            {
                "says": part.says,
                "holds": part.holds,
                "only_if": part.only_if,
                "proved": [{"says": theorem.says, "encloses": theorem.encloses} for theorem in part.theorems],
            }
            for part in result.finding.parts
        ],
        "model": result.test.model,
        "measured": dict(result.measured),
        "explanation": result.finding.explanation,
        "seconds": round(result.seconds, 3),
    }


def claims_json(results: Iterable[Result], claims: Mapping[str, Claim]) -> str:
    """Return the claims as the text of a JSON list."""
    return json.dumps([claim_data(r, claims[r.test.id]) for r in results], indent=1, ensure_ascii=False)
