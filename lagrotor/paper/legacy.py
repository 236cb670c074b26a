"""Statements whose printed side still stands in their script: to be removed when the last of them is in the catalogue."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from lagrotor.paper.ledger import Relation, Statement
from lagrotor.paper.premises import Premise


def stated(
    identifier: str,
    relations: tuple[Relation, ...],
    given: Mapping[sp.Symbol, sp.Expr] | None = None,
    condition: str = "",
    correction: tuple[Relation, ...] = (),
    wrong: str = "",
    quantities: tuple[str, ...] = (),
    definition: bool = False,
    measured: bool = False,
    depends_on: tuple[str, ...] = (),
    evidence: tuple[str, ...] = (),
    steps: tuple[str, ...] = (),
) -> Any:
    """A statement as the scripts made it before."""
    premises = (Premise(condition or ", ".join(f"{k} = {v}" for k, v in given.items()), given),) if given else ()
    named = quantities or ("",) * len(correction)
    corrected = tuple(replace(r, quantity=name) for r, name in zip(correction, named, strict=True))
    return Statement(identifier, relations, premises, corrected, wrong, False, measured, depends_on, evidence)
