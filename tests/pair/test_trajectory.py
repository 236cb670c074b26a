"""What a run leaves: observables against rigid bodies, and files that are whole or not there."""

import csv
import random
import struct
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, Trajectory, simulate
from lagrotor.errors import InputError
from lagrotor.files import read_arrays, write_arrays, write_beside, write_text
from lagrotor.numerics.run import Ending
from lagrotor.pair.trajectory import UNITS

TIMES = np.linspace(0, 2, 21)
ROTOR = Rotor(mass=1.3, length=0.9, I1=0.7, I3=1.1)
BAR = Link(length=1.2, mass=0.4, inertia=0.05)
SCENE = Scene((10, -7), ROTOR, BAR, rates=((0.4, 1.0, 0), (0.4, -0.5, 0)))


@pytest.fixture(scope="module")
def run() -> Trajectory:
    return simulate(SCENE, TIMES, "spheres", 1e-11)


def test_shapes_are_one_row_a_time(run: Trajectory) -> None:
    n = len(TIMES)
    assert run.t.tolist() == TIMES.tolist()
    assert run.axes[:, 0] == pytest.approx(np.array(SCENE.axes)) and run.rates[:, 0] == pytest.approx(
        np.array(SCENE.rates)
    )
    assert {name: getattr(run, name).shape for name in UNITS if name != "P"} == {
        "axes": (2, n, 3), "rates": (2, n, 3), "tips": (2, n, 3),
        "energy": (n,), "link_length": (n,), "momenta": (2, n),
    }  # fmt: skip
    assert {name: part.shape for name, part in run.invariants.items()} == dict.fromkeys(("G_1", "G_2", "P"), (n,))
    assert run.inclinations.shape == run.azimuths.shape == (2, n)
    assert simulate(SCENE, [0.5]).axes.shape == (2, 1, 3)


def test_rates_are_the_derivatives_of_the_axes() -> None:
    h = 1e-4
    near = simulate(SCENE, [0, 1 - h, 1, 1 + h], "minimal", 1e-12).after(0.5)
    slope = (near.axes[:, 2] - near.axes[:, 0]) / (2 * h)
    assert near.rates[:, 1] == pytest.approx(slope, abs=1e-5)
    assert near.rates[:, 1] != pytest.approx(-slope, abs=1e-1)


def bodies_energy(run: Trajectory, link: Link) -> np.ndarray:
    """Two rotors about their centres and the bar, each as a rigid body, tips' velocities in."""
    R, tip_v = ROTOR.length, ROTOR.length * run.rates
    whole = np.zeros(len(run.t))
    for i in (0, 1):
        centre_v = tip_v[i] / 2
        tilting = np.cross(run.axes[i], tip_v[i] / R)
        spin = np.array(SCENE.spins[i])
        whole += ROTOR.mass / 2 * (centre_v**2).sum(-1) + ROTOR.I1 / 2 * (tilting**2).sum(-1) + ROTOR.I3 / 2 * spin**2
    d, d_v = run.tips[1] - run.tips[0], tip_v[1] - tip_v[0]
    turning = np.cross(d, d_v) / link.length**2
    return whole + link.mass / 2 * (tip_v.mean(0) ** 2).sum(-1) + link.inertia / 2 * (turning**2).sum(-1)


def test_energy_is_that_of_three_rigid_bodies(run: Trajectory) -> None:
    assert run.energy == pytest.approx(bodies_energy(run, BAR), rel=1e-11)
    assert run.energy != pytest.approx(bodies_energy(run, Link(1.2, 0.4, 0.06)), rel=1e-6)


def test_the_momentum_about_the_joint_line_is_that_of_three_rigid_bodies(run: Trajectory) -> None:
    R, tip_v = ROTOR.length, ROTOR.length * run.rates
    P = np.zeros(len(run.t))
    for i in (0, 1):
        r, w = run.axes[i], np.cross(run.axes[i], run.rates[i])
        P += ROTOR.mass / 4 * R * np.cross(r, tip_v[i])[:, 0] + (ROTOR.I1 * w)[:, 0]
        P += ROTOR.I3 * SCENE.spins[i] * r[:, 0]
    d, d_v = run.tips[1] - run.tips[0], tip_v[1] - tip_v[0]
    P += BAR.mass * np.cross(run.tips.mean(0), tip_v.mean(0))[:, 0] + BAR.inertia * (np.cross(d, d_v) / 1.2**2)[:, 0]
    assert run.invariants["P"] == pytest.approx(P, abs=1e-10)
    assert np.abs(P).max() > 0.1


def test_tips_stand_on_their_joints_and_the_bar_between_them(run: Trajectory) -> None:
    assert run.joints.tolist() == [[-0.6, 0, 0], [0.6, 0, 0]]
    assert np.linalg.norm(run.tips - run.joints[:, None], axis=-1) == pytest.approx(0.9, abs=1e-13)
    assert run.link_length == pytest.approx(1.2, abs=1e-13)
    # Without a bar the tips go their own way.
    free = simulate(Scene((10, -7), ROTOR, None, rates=SCENE.rates), TIMES)
    assert np.ptp(free.link_length) > 1e-2
    assert free.joints.tolist() == [[-0.45, 0, 0], [0.45, 0, 0]]


def test_angles_describe_the_axes(run: Trajectory) -> None:
    theta, phi = run.inclinations, run.azimuths
    rebuilt = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    assert rebuilt == pytest.approx(run.axes, abs=1e-14)
    assert np.abs(np.diff(phi)).max() < np.pi


def test_csv_holds_every_digit_under_named_columns(run: Trajectory, tmp_path: Path) -> None:
    target = run.save(str(tmp_path / "run.csv"))
    with target.open() as file:
        rows = list(csv.reader(file))
    kinds = (("axes", "1"), ("rates", "1/s"), ("tips", "m"))
    assert rows[0] == [
        "t [s]",
        *(f"{name}_{i}_{letter} [{unit}]" for name, unit in kinds for i in (1, 2) for letter in "xyz"),
        "energy [J]", "link_length [m]", "momenta_1 [kg m²/s]", "momenta_2 [kg m²/s]", "P [kg m²/s]",
    ]  # fmt: skip
    table = np.array(rows[1:], dtype=float)
    vectors = [column for part in (run.axes, run.rates, run.tips) for i in (0, 1) for column in part[i].T]
    expected = [run.t, *vectors, run.energy, run.link_length, *run.momenta, run.joint_line_momentum]
    assert table.T.tolist() == [column.tolist() for column in expected]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("run.txt", r"run\.txt must end in \.npz, \.csv, \.png"),
        ("run.npz.gz", "must end in"),
        ("missing/run.npz", "choose an existing folder"),
        ("missing/run.csv", "choose an existing folder"),
        ("folder.csv", "choose another file"),
    ],
)
def test_where_no_run_can_be_saved_is_refused_and_nothing_left(
    run: Trajectory, tmp_path: Path, name: str, message: str
) -> None:
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(InputError, match=message):
        run.save(tmp_path / name)
    assert [entry.name for entry in tmp_path.iterdir()] == ["folder.csv"]


def test_a_write_that_fails_halfway_leaves_the_old_file_alone(tmp_path: Path) -> None:
    target = write_text(tmp_path / "note", "old é")

    def half(file: object) -> None:
        file.write(b"ne")  # type: ignore[attr-defined]
        raise RuntimeError("halfway")

    with pytest.raises(RuntimeError, match="halfway"):
        write_beside(target, half)
    assert target.read_text(encoding="utf-8") == "old é"
    assert list(tmp_path.iterdir()) == [target]
    write_text(target, "new")
    assert target.read_text() == "new"


def test_a_file_is_as_readable_as_any_other(tmp_path: Path) -> None:
    """The temporary file it was is private; the finished one follows the umask."""
    plain = tmp_path / "plain"
    plain.touch()
    assert write_text(tmp_path / "note", "x").stat().st_mode == plain.stat().st_mode


def test_a_saved_run_is_read_back_with_its_scene(run: Trajectory, tmp_path: Path) -> None:
    again = Trajectory.load(run.save(tmp_path / "run.npz"))
    assert (again.scene, again.model, again.why, again.evaluations) == (run.scene, run.model, run.why, run.evaluations)
    assert (again.axes == run.axes).all() and (again.energy == run.energy).all()
    assert (again.error, again.horizon) == (run.error, run.horizon) and 0 < run.error < 1e-6
    assert again.ending == run.ending and (again.errors == run.errors).all()
    ending = Ending("budget", 1.9, "9 evaluations spent")
    parted = replace(run, errors=0.3 * run.t, horizon=1.25, ending=ending)
    again = Trajectory.load(parted.save(tmp_path / "parted.npz"))
    assert (again.error, again.horizon, again.ending) == (0.6, 1.25, ending)
    unknown = Trajectory.load(replace(run, errors=np.nan * run.t, horizon=np.nan).save(tmp_path / "unknown.npz"))
    assert np.isnan([unknown.error, unknown.horizon]).all()
    shocked = Scene((3, 1), link=None, shock=Shock((1, 0, 0), 0.1, 0.05))
    assert Trajectory.load(simulate(shocked, [0.0, 1.0]).save(tmp_path / "two.npz")).scene == shocked


def test_what_is_no_saved_run_is_refused(run: Trajectory, tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", t=run.t)
    np.savez(tmp_path / "plain.npz", about="{}", t=run.t)
    (tmp_path / "empty.npz").touch()
    write_arrays(tmp_path / "chunk.npz", {"sweep": "a chunk's"}, {"axes": run.axes})
    paths = [
        run.save(tmp_path / "run.csv"),
        *(tmp_path / f"{name}.npz" for name in ("other", "plain", "empty", "chunk")),
    ]
    for path in (*paths, tmp_path / "none.npz", tmp_path):
        with pytest.raises(InputError, match=rf"{path.name}(:| is no run)"):
            Trajectory.load(path)


def spoiled(change: Callable[[dict[str, Any], dict[str, Any]], object], run: Trajectory, target: Path) -> Path:
    """A file of the run with its description and arrays changed, the digest right for what it holds."""
    about, held = read_arrays(run.save(target))
    del about["lagrotor"]
    change(about, held)
    return write_arrays(target, about, held)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda about, held: held.update(axes=np.ones(5)), "do not fit together"),
        (lambda about, held: held.update(axes=held["axes"][:, :-1]), "do not fit together"),
        (lambda about, held: held.update(t=held["t"][:, None]), "do not fit together"),
        (lambda about, held: held.update(t=held["t"][::-1]), "times decrease"),
        (lambda about, held: held.update(rates=held["rates"] * np.nan), "not finite"),
        (lambda about, held: held.update(axes=held["axes"] * 1.01), "no unit vectors"),
        (lambda about, held: about.update(evaluations=-1), "number of evaluations"),
        (lambda about, held: about.update(model=None), "its model"),
        (lambda about, held: held.update(errors=-held["errors"]), "its errors"),
        (lambda about, held: about["ending"].update(kind="late"), "Ending: 'late' at"),
        (lambda about, held: about.update(horizon="late"), "its horizon is no number"),
        (lambda about, held: held.pop("errors"), "no run saved"),
        (lambda about, held: about["scene"]["rotor"].update(mass="heavy"), "no run saved"),
    ],
)
def test_a_file_that_holds_no_motion_is_refused(
    change: Callable[[dict[str, Any], dict[str, Any]], object], reason: str, run: Trajectory, tmp_path: Path
) -> None:
    assert Trajectory.load(spoiled(lambda about, held: None, run, tmp_path / "run.npz")).scene == run.scene
    with pytest.raises(InputError, match=reason):
        Trajectory.load(spoiled(change, run, tmp_path / "run.npz"))


def archive(target: Path, header: str, data: bytes, about: str = "{}") -> Path:
    """An .npz of one array `t` with this header, whatever it declares."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
        for name, text, content in (
            (
                "about.npy",
                f"{{'descr': '<U{len(about)}', 'fortran_order': False, 'shape': ()}}",
                about.encode("utf-32-le"),
            ),
            ("t.npy", header, data),
        ):
            line = text.encode() + b"\n"
            file.writestr(name, b"\x93NUMPY\x01\x00" + struct.pack("<H", len(line)) + line + content)
    return target


@pytest.mark.parametrize(
    ("header", "data", "about"),
    [
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (3000000000000,)}", bytes(80), "{}"),  # 22 TiB
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (10,)}", bytes(72), "{}"),
        ("{'descr': '|O', 'fortran_order': False, 'shape': (10,)}", b"cos\nsystem\n(S'true'\ntR.", "{}"),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (10,)}", bytes(80), "[" * 100_000),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (10,)}", bytes(80), '{"digest": "0"}'),
    ],
)
def test_what_a_header_declares_is_not_trusted(header: str, data: bytes, about: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"run\.npz: .*: (make it anew|give a file)|declares|not plain numbers"):
        Trajectory.load(archive(tmp_path / "run.npz", header, data, about))


def test_a_changed_or_missing_byte_is_seen_or_changes_nothing(run: Trajectory, tmp_path: Path) -> None:
    """Flips and cuts at random places, seed fixed: an InputError with the file's name, or the very same run."""
    short = simulate(SCENE, TIMES[:4], "spheres", 1e-6)
    good = short.save(tmp_path / "run.npz").read_bytes()
    generator, refused = random.Random(5), list[str]()
    for _ in range(600):
        changed = bytearray(good)
        for _ in range(generator.choice((1, 1, 2, 8))):
            changed[generator.randrange(len(good))] ^= 1 << generator.randrange(8)
        cut = generator.randrange(len(good)) if generator.random() < 0.2 else len(good)
        (tmp_path / "run.npz").write_bytes(bytes(changed[:cut]))
        try:
            found = Trajectory.load(tmp_path / "run.npz")
        except InputError as error:
            refused.append(str(error))
        else:
            assert found.scene == short.scene and found.why == short.why
            assert all(
                (getattr(found, name) == getattr(short, name)).all() for name in ("t", "axes", "rates", "momenta")
            )
    assert len(refused) > 400 and all("run.npz" in message for message in refused)


@pytest.mark.parametrize(
    ("ending", "begins"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF"), ("gif", b"GIF8")]
)
def test_a_run_is_saved_as_a_picture_or_a_film(run: Trajectory, tmp_path: Path, ending: str, begins: bytes) -> None:
    short = simulate(run.scene, np.linspace(0, 0.2, 6), tol=1e-6)
    assert short.save(tmp_path / f"run.{ending}").read_bytes().startswith(begins)
