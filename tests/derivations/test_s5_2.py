"""Section 5.2: the verdicts, and independent oracles for what its derivations state."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lagrotor import Link, Scene, paired_scene, simulate
from lagrotor.models.orbits.shooting import exact_orbit
from lagrotor.numerics.convergence import measured_order, swing
from lagrotor.pair.trajectory import ansatz_A
from lagrotor.paper import scripts
from lagrotor.paper.audit import statements
from lagrotor.paper.ledger import Verdict, follow_errors, judge
from lagrotor.theory.paired_precession.closed_forms import paired_frequency

VERDICTS = {
    **dict.fromkeys(("5.01", "5.02", "5.03", "5.04", "5.05"), "holds-if"),
    "5.06": "holds",
    **dict.fromkeys(("5.07", "5.08", "5.09", "5.10", "5.11", "5.12", "5.13"), "holds-if"),
    "5.14": "holds",
    "5.15": "holds-if",
    "5.16": "refuted",
    "5.17": "holds-to-order",
    "5.18": "holds",
    "5.19": "holds-to-order",
    **dict.fromkeys(("5.20", "5.21", "5.22"), "refuted"),
}


@pytest.fixture(scope="module")
def verdicts() -> dict[str, Verdict]:
    stated = [s for stem in scripts.names("derivations", "s5_2") for s in statements(stem)]
    return {v.id: v for v in follow_errors(judge(s) for s in stated)}


def test_verdicts(verdicts: dict[str, Verdict]) -> None:
    assert {i: v.verdict for i, v in verdicts.items()} == VERDICTS


def test_orders_and_domains(verdicts: dict[str, Verdict]) -> None:
    assert (verdicts["5.17"].order, verdicts["5.19"].order) == (3, 3)
    assert [verdicts[i].order for i in ("5.20", "5.22")] == [1, 1]
    assert [str(f) for f in verdicts["5.02"].domain] == ["sin(theta)"]
    assert [str(f) for f in verdicts["5.14"].domain] == ["cos(theta_1) + cos(theta_2)"]


def test_which_errors_reach_a_result(verdicts: dict[str, Verdict]) -> None:
    assert verdicts["5.20"].reaches_result is True, "the trajectories 5.22 carry it on"
    assert verdicts["5.16"].reaches_result is False, "nothing later uses the value of B"
    assert verdicts["5.15"].reaches_result is None, "it is not refuted"


def test_the_energy_of_a_rotor_from_its_rotation() -> None:
    """Against scipy's rotations: kinetic energy of a spinning, tilting body that stands on its joint."""
    from lagrotor.pair.lagrangians import rotor_lagrangian
    from lagrotor.pair.symbols import I3, ROTOR, J

    rng = np.random.default_rng(5)
    I1, axial, mass, length, step = 1.1, 0.7, 1.3, 0.9, 1e-6
    for _ in range(5):
        q, v = rng.uniform(0.3, 1.2, 3), rng.uniform(-2, 2, 3)

        def attitude(time: float, q=q, v=v) -> Rotation:
            theta, phi, psi = q + v * time
            return Rotation.from_euler("ZXZ", [phi, theta, psi])

        turned = (attitude(-step).inv() * attitude(step)).as_rotvec() / (2 * step)
        centre = (attitude(step).apply([0, 0, length / 2]) - attitude(-step).apply([0, 0, length / 2])) / (2 * step)
        kinetic = (I1 * (turned[0] ** 2 + turned[1] ** 2) + axial * turned[2] ** 2 + mass * centre @ centre) / 2
        values = dict(zip((*ROTOR.q, *ROTOR.v), (*q, *v), strict=True)) | {J: I1 + mass * length**2 / 4, I3: axial}
        assert float(rotor_lagrangian().subs(values)) == pytest.approx(kinetic, rel=1e-8)
        without = values | {J: I1}
        assert float(rotor_lagrangian().subs(without)) != pytest.approx(kinetic, rel=1e-4)


@pytest.mark.parametrize("link", [Link(), Link(1, 1, 1)], ids=["massless", "heavy"])
def test_A_swings_on_the_orbit_and_B_does_not(link: Link) -> None:
    amplitudes = (0.05, 0.1)
    swings = []
    for r0 in amplitudes:
        orbit = exact_orbit(Scene(spins=(10, -10), link=link), r0)
        run = simulate(orbit.scene, np.linspace(0, 2 * np.pi / orbit.frequency, 101), "euler", 1e-11)
        swings.append(swing(ansatz_A(run)))
        assert swing(run.momenta[0] - run.momenta[1]) < 1e-10
    # Massless: the bar is free of force to first order on the circles, so A swings as r_0⁴; a heavy bar is not.
    expected = 4 if link.mass == 0 else 2
    assert measured_order(amplitudes, swings) == pytest.approx(expected, abs=0.1)


def test_the_rate_falls_with_amplitude_for_the_paper_s_bars() -> None:
    for link in (Link(), Link(1, 0.01, 0.1), Link(1, 1, 1)):
        scene = Scene(spins=(10, -10), link=link)
        rates = [exact_orbit(scene, r0).frequency for r0 in (0.1, 0.2, 0.3)]
        assert rates[0] > rates[1] > rates[2]
    assert float(paired_frequency(3)(0.2, 1.0, 1.0)) == pytest.approx(1 - 0.2**2 / 4)
    assert float(paired_frequency(3)(0.2, 1.0, 2.0)) > 1, "a massless bar twice as long as the rotors"


def test_centres_of_the_two_curves() -> None:
    """The mean of x_1 over a turn is −ell/2 + r_0²/2 to second order; the paper's is on the other side."""
    scene = paired_scene(Scene(spins=(10, -10)), 0.05)
    orbit = exact_orbit(Scene(spins=(10, -10)), 0.05)
    turn = np.linspace(0, 2 * np.pi / orbit.frequency, 257)[:-1]
    run = simulate(scene, turn, "minimal", 1e-12)
    mean = run.tips[0, :, 0].mean() + 0.5
    assert mean == pytest.approx(0.05**2 / 2, rel=0.02)
    assert abs(mean + 0.05**2 / 2) > 0.9 * 0.05**2


def test_every_number_in_the_evidence_is_computed() -> None:
    """No decimal stands typed in the evidence of a statement: they all come through a format."""
    for stem in scripts.names("derivations", "s5_2"):
        source = (scripts.folder("derivations") / f"{stem}.py").read_text(encoding="utf-8")
        for text in re.findall(r"evidence=\((.*?)\n        \),", source, flags=re.S):
            plain = re.sub(r"\{[^{}]*\}", "", text)
            typed = [
                n for n in re.findall(r"\d+\.\d+", plain) if n not in {"0.204"} and not re.match(r"[1-6]\.\d\d$", n)
            ]
            assert not typed, (stem, typed)
