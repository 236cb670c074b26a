"""The gallery: each system is set up in few lines, proves a textbook's results, is right to 1e-9, and has a picture."""

import pytest
import sympy as sp

from lagrotor.errors import ProofError
from lagrotor.paper import Step, prove
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from tests.report.derivation_faults import faults_of

GALLERY = PAPER.scripts.names("derivations", "g")
# Seconds each; their means are tested on less in tests/mechanics (chains, loops, rolling, impacts, friction) and tests/pair.
LONG = (
    "g02_double_and_triple_pendulum",
    "g11_four_bar_linkage",
    "g13_rolling_disc",
    "g14_chains",
    "g15_paired_gyroscopes",
    "g17_rocking_block",
    "g18_clock",
)
STEMS = [pytest.param(stem, marks=pytest.mark.slow) if stem in LONG else stem for stem in GALLERY]


@pytest.mark.parametrize("stem", STEMS)
def test_it_agrees_with_an_independent_formulation_and_not_with_a_neighbour(stem: str) -> None:
    names = PAPER.scripts.executed("derivations", stem).names
    assert 0 < names["off"] < 1e-9
    assert names["difference"]({**names["values"], **names["twin"]}) > 1e-6


@pytest.mark.parametrize("stem", STEMS)
def test_it_proves_results_and_shows_a_picture(stem: str) -> None:
    script = PAPER.scripts.executed("derivations", stem)
    steps = script.values_of(Step)
    assert steps and all(step.says for step in steps)
    assert faults_of(stem) == []
    picture = script.names["picture"]
    assert len(picture.axes) >= 2 and all(axes.lines for axes in picture.axes)
    # What was proved is not true of anything else.
    for step in steps:
        left, right = step.pairs[0]
        with pytest.raises(ProofError):
            prove(left + sp.ones(*left.shape) if isinstance(left, sp.MatrixBase) else left + 1, right)
