"""Opened as a notebook, a script shows what it reaches: cells that end in a bare expression."""

import ast
import re

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

ENOUGH = 2


def shown(script: str) -> list[str]:
    """The bare expressions that code cells end in, but for calls that hand nothing back."""
    parts = re.split(r"(?m)^# %%(.*)$", script)
    code = [body for kind, body in zip(parts[1::2], parts[2::2], strict=True) if "[markdown]" not in kind]
    last = [statements[-1] for body in code if (statements := ast.parse(body).body)]
    return [ast.unparse(end.value) for end in last if isinstance(end, ast.Expr) and not _silent(end.value)]


def _silent(value: ast.expr) -> bool:
    called = value.func if isinstance(value, ast.Call) else None
    return getattr(called, "id", None) == "print" or getattr(called, "attr", None) in ("append", "extend", "update")


@pytest.mark.parametrize("stem", PAPER.scripts.names("derivations"))
def test_every_script_shows_what_it_reaches(stem: str) -> None:
    script = (PAPER.scripts.path("derivations", stem)).read_text(encoding="utf-8")
    assert len(shown(script)) >= ENOUGH


def test_a_script_that_only_computes_shows_nothing() -> None:
    cells = (
        "rate = 1",
        "assert rate",
        "found.append(rate)",
        "print(rate)",
        "def half():\n    return rate / 2",
        "# why",
    )
    assert shown("# %% [markdown]\n# rate\n\n" + "".join(f"# %%\n{cell}\n\n" for cell in cells)) == []
    assert shown("# %%\nrate = 1\nrate\n\n# %% [markdown]\n# why\n\n# %%\nrate\nrate = 2\n") == ["rate"]
