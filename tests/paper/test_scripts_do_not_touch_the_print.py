"""No derivation edits what is printed, and none puts a premise in where it calls for a verdict."""

import ast
from collections.abc import Iterator

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

STEMS = PAPER.scripts.names("derivations", "s")
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
