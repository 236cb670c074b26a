"""Derivations with their physics changed: what becomes of the verdicts."""

from collections.abc import Callable

import pytest

from lagrotor.paper import scripts
from lagrotor.paper.ledger import Statement, Verdict, judge

Edit = tuple[str, str, str]  # script, text, what takes its place


@pytest.fixture
def changed_physics(tmp_path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., dict[str, Verdict]]:
    """Verdicts of scripts that are run in this order with some text edited; later ones see the edited earlier ones.

    Proofs are let pass, or they would refuse before anything is judged.
    """

    def verdicts(edits: list[Edit], *stems: str) -> dict[str, Verdict]:
        ran: dict[str, scripts.Script] = {}
        original = scripts.run
        monkeypatch.setattr("lagrotor.paper.proof.prove", lambda *sides, **more: None)
        monkeypatch.setattr("lagrotor.paper.stating.needs_premises", lambda *compared: False)
        monkeypatch.setattr(scripts, "run", lambda kind, stem: ran[stem].names if stem in ran else original(kind, stem))
        for stem in stems:
            text = (scripts.folder("derivations") / f"{stem}.py").read_text(encoding="utf-8")
            for _, old, new in (edit for edit in edits if edit[0] == stem):
                assert text.count(old) == 1, (stem, old)
                text = text.replace(old, new)
            path = tmp_path / f"{stem}.py"
            path.write_text(text, encoding="utf-8")
            ran[stem] = scripts.run_file(path)
        return {s.id: judge(s) for script in ran.values() for s in script.shown(Statement)}

    return verdicts
