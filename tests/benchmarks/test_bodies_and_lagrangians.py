"""The arm and the bicycle: from bodies, from the Lagrangian written out and by sympy the same accelerations."""

import numpy as np
import pytest

from benchmarks import bodies_and_lagrangians
from benchmarks.bodies_and_lagrangians import ARM, TOOLS, arm


def test_an_arm_from_its_lagrangian_moves_as_its_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    y = np.random.default_rng(2).uniform(-0.5, 0.5, 12)
    known = np.array(arm(bodies=True)(0.0, y))
    np.testing.assert_allclose(arm(bodies=False)(0.0, y), known, atol=1e-11 * np.abs(known).max())
    monkeypatch.setitem(ARM, "m_5", 0.6)
    assert np.abs(np.array(arm(bodies=True)(0.0, y)) - known).max() > 1e-3  # the twin


@pytest.mark.slow
@pytest.mark.parametrize(("name", "tool"), [("arm", "KanesMethod"), *(("bicycle", tool) for tool in TOOLS[1:])])
def test_sympy_has_the_same_accelerations(name: str, tool: str) -> None:
    sent = list[tuple[float, float | None, float]]()
    bodies_and_lagrangians._measured(sent.append, lambda: None, name, tool)
    assert sent[0][1] is not None and sent[0][2] < 1e-9
