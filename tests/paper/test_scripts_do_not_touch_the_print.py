"""No derivation edits what is printed, and none puts a premise in before the ledger looks."""

import ast
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from lagrotor.pair import INERTIAS, J_OF
from lagrotor.pair.notation import G_1, G_2, GLOSSARY, I3, G, J, omega, omega_1, omega_2, r0, theta_0
from lagrotor.paper import Stated, Statement, scripts
from lagrotor.paper.rotor_pair.own_paper import PAPER

STEMS = PAPER.scripts.names("derivations", "s")
# What a letter means is no premise: it may be written out.
MEANINGS = {**INERTIAS, J: J_OF, G: I3 * omega, G_1: I3 * omega_1, G_2: I3 * omega_2, r0: sp.sin(theta_0)}
PARAMETERS = {
    s for s, entry in GLOSSARY.items() if entry.unit in ("kg", "m", "kg m²", "rad/s", "kg m²/s") and s.is_Symbol
} - {s for s in GLOSSARY if s.name.endswith(("_dot", "_ddot"))}
PUT_IN = ("subs", "xreplace", "replace", "limit", "evalf", "series")


def source(stem: str) -> str:
    return (PAPER.scripts.path("derivations", stem)).read_text(encoding="utf-8")


def calls(text: str, name: str) -> Iterator[ast.Call]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name:
            yield node


def reads_the_print(text: str) -> list[str]:
    """Names by which a script could reach the printed lines."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module == "lagrotor.paper.catalogue":
            found.append(node.module)
        if isinstance(node, ast.Attribute) and node.attr in ("lines", "members", "relations"):
            found.append(node.attr)
    return found


def puts_in(text: str) -> list[str]:
    """Substitutions written into the call of a verdict."""
    inside = (node for call in calls(text, "verdict") for node in ast.walk(call) if isinstance(node, ast.Attribute))
    return [node.attr for node in inside if node.attr in PUT_IN]


@pytest.mark.parametrize("stem", STEMS)
def test_no_script_reaches_the_print(stem: str) -> None:
    assert reads_the_print(source(stem)) == []


@pytest.mark.parametrize("stem", STEMS)
def test_nothing_is_put_in_where_a_verdict_is_called(stem: str) -> None:
    assert puts_in(source(stem)) == []


def test_a_script_that_edits_or_puts_in_would_be_seen() -> None:
    assert reads_the_print("from lagrotor.paper.catalogue import equation\nequation('5.01').lines[0]")
    assert puts_in("verdict('5.06', rate.subs({J: I3}))") == ["subs"]


class Watch:
    """Results of substitutions that set a parameter to a number or to another parameter, while a script runs."""

    def __init__(self) -> None:
        self.results: set[sp.Basic] = set()

    def wrapped(self, subs: Callable[..., Any]) -> Callable[..., Any]:
        def watched(expression: sp.Basic, *args: Any, **more: Any) -> Any:
            result = subs(expression, *args, **more)
            if result != expression and self._assumes(args):
                self.results |= set(result) if isinstance(result, sp.MatrixBase) else {result}
            return result

        return watched

    def _assumes(self, args: tuple[Any, ...]) -> bool:
        pairs = [args] if len(args) == 2 else getattr(args[0], "items", lambda: args[0])()
        return any(
            old in PARAMETERS and MEANINGS.get(old) != new and (sp.sympify(new).is_number or new in PARAMETERS)
            for old, new in pairs
        )

    def seen_in(self, statement: Statement) -> bool:
        for relation in statement.relations:
            entries = relation.derived if isinstance(relation.derived, sp.MatrixBase) else [relation.derived]
            if any(entry in self.results for entry in entries if not (entry.is_Symbol or entry.is_number)):
                return True
        return False


def watched_run(path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Ids whose derived side came out of such a substitution in the script."""
    watch = Watch()
    with monkeypatch.context() as patch:
        patch.setattr(sp.Basic, "subs", watch.wrapped(sp.Basic.subs))
        script = scripts.run_file(path)
    return [stated.id for stated in script.shown(Stated) if watch.seen_in(PAPER.statement(stated))]


@pytest.mark.parametrize("stem", STEMS)
def test_no_premise_is_put_in_before_the_ledger_looks(stem: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert watched_run(PAPER.scripts.path("derivations", stem), monkeypatch) == []


BY_HAND = """
from lagrotor.pair import rotor_lagrangian
from lagrotor.pair.notation import I3, J
from lagrotor.paper import verdict

L = rotor_lagrangian()
verdict("5.01", L)
L = L.subs(J, I3)
verdict("5.01", L)
"""


def test_a_premise_put_in_by_hand_would_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = tmp_path / "by_hand.py"
    script.write_text(BY_HAND, encoding="utf-8")
    assert watched_run(script, monkeypatch) == ["5.01"], "the second of the two, not the first"
    script.write_text(BY_HAND.replace("L = L.subs(J, I3)", ""), encoding="utf-8")
    assert watched_run(script, monkeypatch) == []
