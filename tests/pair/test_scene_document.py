"""A scene as TOML: written and read back to the same, and what is none refused with the reason."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lagrotor import Link, Rotor, Scene, Shock, read_scene, write_scene
from lagrotor.errors import InputError
from lagrotor.pair.scene_document import scene_of, scene_toml

SIZES = st.floats(0.01, 100)
SPINS = st.integers(-5000, 5000).map(lambda n: n / 97)
SCENES = st.builds(
    Scene,
    spins=st.tuples(SPINS, SPINS),
    rotor=st.builds(Rotor, mass=SIZES, length=SIZES),
    link=st.none() | st.builds(Link, length=SIZES, mass=SIZES, inertia=SIZES),
    shock=st.none()
    | st.builds(Shock, st.just((40.0, -11.0, 0.0)), at=SIZES, width=SIZES, body=st.sampled_from((1, 2))),
)


@given(SCENES)
def test_what_is_written_is_read_back(scene: Scene) -> None:
    import tomllib

    assert scene_of(tomllib.loads(scene_toml(scene))) == scene


def test_a_file_is_read_and_written(tmp_path) -> None:
    scene = Scene(spins=(12, -3), link=Link(mass=1, inertia=0.2))
    assert read_scene(write_scene(scene, tmp_path / "scene.toml")) == scene


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("spins = [1, 2", "is no TOML"),
        ("", "spins is missing"),
        ("spins = [1, 2]\nspin = 3", "'spin' is no field of a scene"),
        ("spins = [1, 2]\nlink = 3", "must be a table of length, mass, inertia"),
        ("spins = [1, 2]\n[link]\nweight = 2", "must be a table of"),
        ("spins = [1, 2]\n[shock]\nat = 2", "shock = .* lacks force"),
        ("spins = [1, 'x']", "is not a finite number"),
    ],
)
def test_what_is_no_scene_is_refused(tmp_path, text: str, reason: str) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=reason):
        read_scene(path)


def test_a_file_that_is_not_there_is_refused(tmp_path) -> None:
    with pytest.raises(InputError, match="No such file or directory: give a file that can be read"):
        read_scene(tmp_path / "none.toml")
