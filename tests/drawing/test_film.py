"""Motion: bodies turned along a run against exact rotations, wheels that stay rigid, films of the right size."""

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from lagrotor import Scene, Shock, consistent_scene, paired_frequency, simulate
from lagrotor.commands.command_line import main
from lagrotor.drawing import Camera
from lagrotor.drawing.film import SIZE, frame_times
from lagrotor.drawing.wheel import place_points, wheel
from lagrotor.errors import InputError
from lagrotor.numerics import body_rotations
from lagrotor.numerics.rotations import between_samples, turn_between
from lagrotor.pair import SCENES
from lagrotor.theory.natural_frequency import natural_frequency

START = np.array([[0.3, 0.2, np.sqrt(0.87)], [0.0, 0.0, 1.0]])
RATES = np.array([[0.6, -0.9, 0.0], [1.0, 0.5, 0.0]])
RATES[0] -= (RATES[0] @ START[0]) * START[0]
SPINS = (10.0, -7.0)


def free_run(n):
    """Two uncoupled rotors, the second through the upright position again and again, read at n times up to 5 s."""
    scene = Scene(SPINS, link=None, axes=START, rates=RATES)
    return simulate(scene, np.linspace(0, 5, n), model="spheres", tol=1e-12)


def exact_rotation(i, t, first):
    """Q(t) = exp([L] t/J) exp([r] (1/I3 − 1/J)(L . r) t) Q(0) of a symmetric body turning about a fixed point."""
    J, I3 = Scene(SPINS).rotor.J, Scene(SPINS).rotor.I3
    L = J * np.cross(START[i], RATES[i]) + I3 * SPINS[i] * START[i]
    spin = np.outer(t, START[i] * (1 / I3 - 1 / J) * (L @ START[i]))
    return (Rotation.from_rotvec(np.outer(t, L / J)) * Rotation.from_rotvec(spin)).as_matrix() @ first


# --- rotations along a run


def test_bodies_turn_as_the_exact_free_rotor_to_fourth_order():
    """The twin: the spin alone, carried along great circles, loses the area that the path encloses."""
    errors = []
    for n in (101, 201, 401):
        run = free_run(n)
        Q = body_rotations(run.t, run.axes, run.rates, run.momenta[:, 0] / run.scene.rotor.I3)
        errors.append(max(np.abs(Q[i] - exact_rotation(i, run.t, Q[i, 0])).max() for i in (0, 1)))
    assert errors[-1] < 3e-7
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([4, 4], abs=0.2)
    still = body_rotations(run.t, run.axes, 0 * run.rates, np.array(SPINS))
    assert np.abs(still[0] - exact_rotation(0, run.t, still[0, 0])).max() > 1e-5


def test_a_start_that_hangs_and_a_turn_right_round():
    down, up = np.array([[[0.0, 0.0, -1.0]]]), np.array([[[0.0, 0.0, 1.0]]])
    hanging = body_rotations(np.zeros(1), down, 0 * down, np.zeros(1))
    assert hanging[0, 0, :, 2] == pytest.approx([0, 0, -1])
    assert np.linalg.det(hanging[0, 0]) == pytest.approx(1)
    with pytest.raises(InputError, match="more samples"):
        turn_between(up, down)


def test_between_samples_is_of_fourth_order_and_refuses_times_outside():
    fine = free_run(801)
    errors = []
    for step in (20, 10):
        r, v = between_samples(fine.t[::step], fine.axes[:, ::step], fine.rates[:, ::step], fine.t)
        errors.append(np.abs(r - fine.axes).max())
        assert np.abs((r * v).sum(-1)).max() < 1e-12
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.4)
    with pytest.raises(InputError, match="all times must lie between them"):
        between_samples(fine.t, fine.axes, fine.rates, np.array([5.1]))


# --- wheels and camera


def test_wheel_is_that_of_the_paper():
    points, segments = wheel(0.4, 1.0, 6)
    assert points.shape == (8, 3)
    assert segments.shape == (3 * 6 + 1, 2)
    lengths = np.linalg.norm(points[segments[:, 0]] - points[segments[:, 1]], axis=1)
    assert lengths[:6] == pytest.approx(0.4)  # a hexagon's side is its radius
    assert lengths[6:-1] == pytest.approx(np.hypot(0.4, 0.5))
    assert lengths[-1] == pytest.approx(1.0)
    assert (np.bincount(segments.ravel()) == [4] * 6 + [7] * 2).all()
    rounder, more = wheel(0.4, 1.0, 6, arcs=4)
    assert rounder.shape == (26, 3)
    assert more.shape == (24 + 12 + 1, 2)
    with pytest.raises(InputError):
        wheel(0.4, 1.0, 2)


def test_wheel_stays_rigid_along_a_run():
    ready = SCENES["anti-spin-shock-y"]
    run = simulate(ready.scene, np.linspace(0, 10, 501))
    moving = run.motion(run.t[::10])
    points, segments = wheel(0.4, run.scene.rotor.length, 7)
    placed = place_points(points, moving.rotations, moving.centres)
    lengths = np.linalg.norm(placed[..., segments[:, 0], :] - placed[..., segments[:, 1], :], axis=-1)
    still = np.linalg.norm(points[segments[:, 0]] - points[segments[:, 1]], axis=-1)
    assert np.abs(lengths - still).max() < 1e-12
    assert np.abs(placed[..., -1, :] - moving.tips).max() < 1e-12  # the axle runs from the ground joint to the tip
    assert np.abs(placed[..., -2, :] - moving.joints[:, None]).max() < 1e-12


def test_camera_is_orthonormal_and_right_handed():
    frame = Camera(33.0, 21.0).frame
    assert np.abs(frame @ frame.T - np.eye(3)).max() < 1e-14
    assert np.linalg.det(frame) == pytest.approx(1)
    assert Camera(-90.0, 0.0)(np.eye(3)) == pytest.approx(np.array([[1, 0], [0, 0], [0, 1.0]]))


# --- films


@pytest.fixture(scope="module")
def short():
    ready = SCENES["free-precession"]
    return simulate(ready.scene, np.linspace(0, 2.4, 121))


def test_frame_times():
    assert frame_times(0.0, 1.0, 4.0) == pytest.approx([0, 0.25, 0.5, 0.75, 1])
    assert frame_times(0.0, 0.9, 4.0) == pytest.approx([0, 0.25, 0.5, 0.75])
    assert frame_times(0.3, 0.9, 10.0) == pytest.approx(np.arange(3, 10) / 10)


def test_gif_has_its_frames_size_and_duration(short, tmp_path):
    seconds = []
    path = short.animate(tmp_path / "pair.gif", fps=15, step=seconds.append)
    assert seconds == ["second 1", "second 2", "second 3"]
    with Image.open(path) as film:
        assert (film.n_frames, film.size) == (37, SIZE)
        duration, colours = 0, set()
        for i in range(film.n_frames):
            film.seek(i)
            duration += film.info["duration"]
            colours |= {colour for _, colour in film.convert("RGB").getcolors(1 << 16)}
        assert film.info["loop"] == 0
    assert duration == pytest.approx(37 / 15 * 1000, abs=10)
    assert (255, 255, 255) in colours
    assert len(colours) <= 128
    assert list(tmp_path.iterdir()) == [path]


def test_interrupted_leaves_nothing(short, tmp_path):
    def stop(name):
        if name == "second 2":
            raise KeyboardInterrupt

    old = tmp_path / "pair.gif"
    old.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt):
        short.animate(old, step=stop)
    assert old.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [old]


# --- command line, prompt and notebook


@pytest.mark.parametrize(
    ("argv", "says"),
    [
        (["spin"], "invalid choice: 'spin'"),
        ([], "SCENE"),
        (["same-spin", "--out", "pair.txt"], "end in .gif"),
        (["same-spin", "--out", "missing/pair.gif"], "no folder missing"),
        (["same-spin", "--out", "."], "end in .gif"),
        (["same-spin", "--t-end", "0"], "0 s"),
        (["same-spin", "--t-end", "nan"], "nan s"),
        (["same-spin", "--t-end", "1e9"], "to 600 s"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(argv, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["animate", *argv]) == 2
    out, err = capsys.readouterr()
    assert err.startswith("lagrotor: ")
    assert err.count("\n") == 1
    assert says in err
    assert not out
    assert not list(tmp_path.iterdir())


def test_command_writes_the_scene(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["animate", "no-spin", "--t-end", "0.5"]) == 0
    assert capsys.readouterr().out == "no-spin.gif\n"
    with Image.open(tmp_path / "no-spin.gif") as film:
        assert film.n_frames == 13


def test_help_names_every_scene(capsys):
    assert main(["animate", "--help"]) == 0
    shown = capsys.readouterr().out
    assert all(name in shown and ready.says in shown for name, ready in SCENES.items())


def test_trajectory_as_html(short):
    shown = short._repr_html_()
    assert shown.startswith("<table>")
    assert "minimal: smallest exact model" in shown
    assert "10, −10" in shown
    scene = consistent_scene((1.0, 2.0), ((0, 0, 1), (0, 0, 1)), shock=Shock((1.0, 0.0, 0.0), 5.0, 0.1))
    assert "&lt;" not in simulate(scene, [0.0, 1.0])._repr_html_()
    alone = simulate(Scene((1.0, 2.0), link=None), [0.0, 1.0])._repr_html_()
    assert "<th>bar</th><td>none</td>" in alone


def test_closed_form_as_latex():
    assert natural_frequency()._repr_latex_().startswith(r"$\displaystyle \begin{aligned} \Omega_0 &= \frac{")
    assert r"\Omega/\Omega_0 &=" in paired_frequency(3)._repr_latex_()
