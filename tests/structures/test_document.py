"""A structure as TOML and back, the gallery, the command."""

import json

import pytest

from lagrotor import Brace, Link, Rotor, Structure
from lagrotor.commands.command_line import main
from lagrotor.errors import InputError
from lagrotor.structures import GALLERY, example, read_structure, write_structure
from lagrotor.structures.structure import structure_of, toml_of

STANDS = {
    "top": True, "pair": False, "loaded-pair": False, "braced-pair": True, "corner": True, "row": False, "square": True,
    "plate": False, "hexagon": True, "grid": True,
}  # fmt: skip


@pytest.mark.parametrize("name", GALLERY)
def test_the_gallery_is_read_back_as_it_was_written(name, tmp_path) -> None:
    s = example(name)
    assert read_structure(write_structure(s, tmp_path / "s.toml")) == s
    assert s.stands().stands is STANDS[name]


def test_every_field_is_kept() -> None:
    s = Structure(
        joints=[(0, 0), (1, 0.1), (0.5, 2)], bars=[(0, 1), (1, 2, 1.9)], spins=[1, -2, 3.5], rotor=[Rotor(),
        Rotor(2), Rotor()],
        link=[Link(), Link(1, 0.2, 0.1)], gravity=9.81, load=[0, 1, 2], friction=0.1, hinge=[0, 1, 0], spin_friction=0.01,
        braces=[Brace(0, 2, 3.0, 0.1), Brace(1, (0.0, 1.0, 0.5), 2.0)],
    )  # fmt: skip
    import tomllib

    assert structure_of(tomllib.loads(toml_of(s))) == s


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("joints = [[0, 0]", "no TOML"),
        ("bars = []", "joints is missing"),
        ("joints = [[0, 0]]\nspin = 3", "'spin' is no field"),
        ("joints = [[0, 0]]\n[rotor]\nweight = 3", "must be a table of mass"),
        ("joints = [[0, 0]]\n[[braces]]\ntip = 0", "lacks to"),
        ("joints = [[0, 0]]\nload = -1", "negative"),
        ("joints = 3", "must be a list"),
        ('joints = [["a", 0]]', "not a finite number"),
        ("joints = [[0, 0]]\nrotor = 3", "must be a table"),
    ],
)
def test_a_file_that_is_no_structure_is_refused(text, reason, tmp_path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=reason) as refusal:
        read_structure(path)
    assert "bad.toml" in str(refusal.value)


def test_the_command_says_whether_it_stands(capsys, tmp_path) -> None:
    path = tmp_path / "c.toml"
    assert main(["structure", "corner", "--out", str(path)]) == 0
    assert "yes: linearly stable: the spins hold" in capsys.readouterr().out
    assert main(["structure", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (
        found["stands"] and found["degrees_of_freedom"] == 4 and len(found["modes"]) == 4 and found["critical_spin"] < 1
    )
    assert main(["structure", "list", "--json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == GALLERY.keys()
    assert main(["structure", "list"]) == 0
    listed = capsys.readouterr().out
    assert all(f"\n{name} " in listed for name in GALLERY)
    assert main(["structure", "loaded-pair"]) == 0
    assert "no spin suffices" in capsys.readouterr().out


def test_where_a_bar_keeps_it_from_being_upright_the_command_says_what_can_be_done(capsys, tmp_path) -> None:
    path, picture = tmp_path / "long.toml", tmp_path / "long.png"
    path.write_text("joints = [[0, 0], [1, 0]]\nbars = [[0, 1, 1.5]]")
    assert main(["structure", str(path), "--out", str(picture)]) == 0 and picture.exists()
    assert "not judged: upright, a bar is not as long as the distance of its tips" in capsys.readouterr().out
    assert main(["structure", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["stands"] is None
    panels = [[text.get_text() for text in s.plot().axes[1].texts] for s in (read_structure(path), example("corner"))]
    assert "does not have" in panels[0][0] and not panels[1]


def test_the_command_draws(tmp_path, capsys) -> None:
    for name in ("square.png", "square.gif"):
        assert main(["structure", "square", "--out", str(tmp_path / name)]) == 0
        assert (tmp_path / name).stat().st_size > 1000
        assert capsys.readouterr().out.endswith(f"{tmp_path / name}\n")


@pytest.mark.parametrize(
    "given",
    [
        ["nothing"],
        ["missing.toml"],
        ["corner", "--out", "c.docx"],
        ["corner", "--out", "/no/c.png"],
    ],
)
def test_the_command_refuses_in_a_line(given, capsys) -> None:
    assert main(["structure", *given]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_run_is_plotted() -> None:
    s = example("corner")
    picture = s.simulate([0, 0.1, 0.2], tilt=[(0.1, 0)] * 3).plot()
    assert len(picture.axes) == 5 and len(s.plot().axes) == 2


def test_a_film_shows_bars_braces_and_the_sense_of_the_spins(monkeypatch, tmp_path) -> None:
    from lagrotor.drawing import film

    shown = {}
    monkeypatch.setattr(film, "animate_lines", lambda path, t, lines, fps, inks: shown.update(lines=lines, inks=inks))
    braces = [Brace(0, 2, 5.0), Brace(1, (0, -1, 0), 5.0)]
    s = Structure([(0, 0), (1, 0), (1, 1)], [(0, 1)], [3, -3, 3], hinge=1, braces=braces)
    s.simulate([0, 0.1], tilt=[(0, 0.1)] * 3, tol=1e-5).animate(tmp_path / "b.gif")
    bar, spring, tie, *rotors = shown["lines"]
    assert len(rotors) == 3 and len(set(shown["inks"][:3])) == 2
    assert shown["inks"][3] == shown["inks"][5] != shown["inks"][4]
    assert (
        (spring[:, 0] == rotors[2][:, 1]).all()
        and (spring[:, 1] == bar[:, 0]).all()
        and (tie[:, 0] == (0, -1, 0)).all()
    )
