"""Figures 1 to 16: the paper's numbers, read off them."""

import pytest


@pytest.mark.parametrize("number", range(7, 14))
def test_captions_say_how_it_was_simulated(script, number):
    """Model, step, stiffness and bar."""
    words = ("Spring-link model", "step of 0.001 s", "N/m", "bar of 1 kg")
    assert all(word in script(number)["CAPTION"] for word in words)


def test_the_papers_energies(script):
    """4.02 and 4.03: the spike and decay of the misplaced bar, 100 J, 100 to about 100.45 J; the exact model beside."""
    spike, level, shock = (script(n)["measure"]() for n in (8, 9, 10))
    assert 150 < spike["kinetic energy, peak (J)"] < 250
    assert spike["kinetic energy at the end (J)"] == pytest.approx(100, abs=1e-6)
    assert spike["total energy at the start (J)"] == pytest.approx(100 + 2 * 1e4 * 0.5**2 / 2)
    assert level["largest distance from 100 J (J)"] < 1e-9
    assert shock["energy, largest (J)"] == pytest.approx(100.45, abs=0.005)
    assert shock["exact energy after the shock (J)"] == pytest.approx(100.45, abs=0.005)
    assert shock["longest stable step (s)"] > 1e-3


def test_spike_decays_as_the_joints_say(script):
    found = script(8)["measure"]()
    assert found["decay of the kinetic energy (1/s)"] == pytest.approx(
        found["decay by the joints' mobility (1/s)"], rel=1e-2
    )
    assert found["decay by the joints' mobility (1/s)"] != pytest.approx(2 * 1e4 / 250, rel=1e-2)  # 2 S/D: too simple


def test_shocks_hold_x_and_topple_y(script):
    """Section 5: without spin the pair falls in x; with opposite spins x is held, whichever way the shock points."""
    ranges = {n: script(n)["measure"]() for n in (11, 12, 13)}
    assert ranges[11]["x of the centre, range (m)"] > 0.8
    assert ranges[11]["y of the centre, range (m)"] == 0
    for n in (12, 13):
        assert ranges[n]["x of the centre, range (m)"] < 0.2
        assert ranges[n]["y of the centre, range (m)"] > 1.5 * ranges[n]["x of the centre, range (m)"]
        assert ranges[n]["centre at 10 s, off the exact model (m)"] < 0.05


def test_diagrams_are_the_models_geometry(script):
    bar, forces, wheels = (script(n)["measure"]() for n in (15, 2, 7))
    assert bar["length of the bar (m)"] == pytest.approx(1, abs=1e-9)
    assert bar["axes against r(theta, phi)"] < 1e-12
    assert max(forces.values()) < 1e-12
    assert script(14)["measure"]()["e_3 against r(theta, varphi - pi/2)"] < 1e-12
    assert wheels["rate of the wheel (rad/s)"] == pytest.approx(10, abs=1e-9)
    assert script(6)["measure"]()["longest link at the start (m)"] == 0


def test_design_names_every_public_method(script):
    """Figure 3 is read off the classes: nothing that is public is left out."""
    from lagrotor.models.spring_link.system import RigidBodySystem

    shown = {line.split("(")[0] for line in script(3)["data"]()["RigidBodySystem"]}
    public = {name for name, value in vars(RigidBodySystem).items() if callable(value) and not name.startswith("_")}
    assert shown == public | {"RigidBodySystem"}
