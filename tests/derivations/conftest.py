"""Derivations with their physics changed: what becomes of the verdicts."""

from collections.abc import Callable

import pytest

from lagrotor.paper import Stated, Verdict, scripts
from lagrotor.paper.equation_statements import statement
from lagrotor.paper.ledger import decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

Edit = tuple[str, str, str]  # script, text, what takes its place


@pytest.fixture
def changed_physics(tmp_path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., dict[str, Verdict]]:
    """Verdicts of scripts that are run in this order with some text edited; later ones see the edited earlier ones.

    Proofs are let pass, or they would refuse before anything is judged.
    """

    def verdicts(edits: list[Edit], *stems: str) -> dict[str, Verdict]:
        ran: dict[str, scripts.Script] = {}
        monkeypatch.setattr("lagrotor.paper.proof.prove", lambda *sides, **more: None)
        monkeypatch.setattr("lagrotor.paper.equation_statements.needs_premises", lambda *compared: False)
        for stem in stems:
            original = PAPER.scripts.path("derivations", stem)
            text = original.read_text(encoding="utf-8")
            for _, old, new in (edit for edit in edits if edit[0] == stem):
                assert text.count(old) == 1, (stem, old)
                text = text.replace(old, new)
            path = tmp_path / f"{stem}.py"
            path.write_text(text, encoding="utf-8")
            ran[stem] = scripts.run_file(path)
            monkeypatch.setitem(PAPER.scripts.ran, original, ran[stem])
        return {s.id: decide(statement(s, PAPER)) for script in ran.values() for s in script.values_of(Stated)}

    return verdicts
