"""The scenes of a sweep: sequences, iterators of chunks and tables give the same runs; anything else is refused in words."""

from collections.abc import Callable, Iterable
from dataclasses import asdict, fields
from typing import Any

import numpy as np
import pytest

from lagrotor import Link, Rotor, Scene, Shock, sweep
from lagrotor.errors import InputError
from lagrotor.models.sweeps.column_names import scenes_of_table
from lagrotor.models.sweeps.scene_columns import LazyScenes, SceneColumns
from tests.models.sweep_family import T, assert_same_bits, family

SCENES = family(9)
WHOLE = SceneColumns.of_scenes(SCENES)
VECTORS = [f"{i}{x}" for i in "12" for x in "xyz"]


def nested() -> dict[str, Any]:
    parts = {name: column for name, column in flat().items() if name.startswith(("link", "rotor", "shock"))}
    return parts | {name: [getattr(scene, name) for scene in SCENES] for name in ("spins", "axes", "rates")}


def flat() -> dict[str, Any]:
    def of_part(name: str, key: str) -> list[float]:
        return [asdict(part)[key] if (part := getattr(scene, name)) else np.nan for scene in SCENES]

    columns: dict[str, Any] = {f"spins_{i + 1}": WHOLE.spins[:, i] for i in range(2)} | {"rotor_I1": 1.0}
    for name in ("axes", "rates"):
        values = getattr(WHOLE, name).reshape(9, 6)
        columns |= {f"{name}_{label}": values[:, i] for i, label in enumerate(VECTORS)}
    columns |= {f"link_{key}": of_part("link", key) for key in ("length", "mass", "inertia")}
    columns |= {f"shock_{key}": of_part("shock", key) for key in ("at", "width", "body")}
    force = np.array([scene.shock.force if scene.shock else (np.nan,) * 3 for scene in SCENES])
    return columns | {f"shock_force_{x}": force[:, i] for i, x in enumerate("xyz")}


def frame(columns: dict[str, Any]) -> Any:
    return pytest.importorskip("pandas", reason="the extra `notebook` is not installed").DataFrame(columns)


TABLES: dict[str, Callable[[], Any]] = {
    "nested names": nested,
    "flat names": flat,
    "arrays of shape (n, 2), (n, 2, 3)": lambda: nested() | {n: getattr(WHOLE, n) for n in ("spins", "axes", "rates")},
    "one value for all": lambda: flat() | {"shock_body": 2, "rotor_mass": 1, "link_mass": np.float32(0)},
    "nested force": lambda: {n: v for n, v in flat().items() if "force" not in n} | {"shock_force": WHOLE.shock[:, :3]},
    "a table with flat names": lambda: frame(flat()),
    "a table with tuples": lambda: frame(nested()),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_gives_the_scenes(name: str) -> None:
    scenes = scenes_of_table(TABLES[name]())
    for field in fields(SceneColumns):
        np.testing.assert_array_equal(getattr(scenes, field.name), getattr(WHOLE, field.name), err_msg=field.name)


WAYS: dict[str, Callable[[], Iterable[Any]]] = {
    "a tuple": lambda: tuple(SCENES),
    "the scenes of other runs": lambda: LazyScenes(WHOLE),
    "columns": lambda: WHOLE,  # type: ignore[dict-item,return-value]
    "a table": nested,
    "a list of chunks": lambda: [SCENES[:4], SCENES[4:8], SCENES[8:]],
    "an iterator of scenes": lambda: iter(SCENES),
    "an iterator of chunks": lambda: iter([SCENES[:4], tuple(SCENES[4:8]), SCENES[8:]]),
    "an iterator of tables and scenes": lambda: iter([WHOLE.take(range(8)), SCENES[8]]),
}


@pytest.mark.parametrize("name", WAYS)
def test_every_way_gives_the_same_bits(name: str) -> None:
    assert_same_bits(sweep(WAYS[name](), T, chunk=4), sweep(SCENES, T, chunk=4))


@pytest.mark.parametrize("engine", ["core", "fast"])
def test_the_size_of_a_chunk_changes_no_bit(engine: str) -> None:
    """It depends on the number of workers unless it is given."""
    if engine == "fast":
        pytest.importorskip("heyoka", reason="the extra `fast` is not installed")
    scenes = [scene for scene in SCENES if engine == "core" or not scene.shock]
    whole = sweep(scenes, T, engine=engine)
    for chunk in (1, 5):
        assert_same_bits(sweep(scenes, T, chunk=chunk, engine=engine), whole)


def test_what_is_missing_is_the_default_and_a_bar_without_a_length_is_none() -> None:
    table = {"spins": (10, -10), "link_length": [1.5, np.nan, 2], "link_mass": [1, 2, 3], "shock_at": [0, np.nan, 2]}
    scenes = scenes_of_table(
        table | {"shock_force": [(1, 0, 0), (np.nan,) * 3, (0, 1, 0)], "shock_width": [1, np.nan, 1]}
    )
    expected = [
        Scene((10, -10), link=Link(1.5, 1), shock=Shock((1, 0, 0), 0, 1)),
        Scene((10, -10), link=None),
        Scene((10, -10), Rotor(), Link(2, 3), Shock((0, 1, 0), 2, 1)),
    ]
    assert [scenes.scene(i) for i in range(3)] == expected
    assert scenes_of_table({"spins": (10, -10)}).scene(0) == Scene((10, -10))


PAIR = {"spins": (10, -10)}
REFUSED: dict[str, tuple[Any, str]] = {
    "near name": (PAIR | {"rate_1x": 1}, r"'rate_1x' is no column of scenes: rates_1x"),
    "far name": (PAIR | {"colour": 1}, r"'colour' is no column of scenes: the names are spins, axes,"),
    "lengths": ({"spins_1": [1, 2], "spins_2": [1, 2, 3]}, r"the column spins_1 has 2 rows, spins_2 has 3"),
    "twice": (PAIR | {"spins_2": 1}, r"spins and spins_2 both state spins_2"),
    "no spins": ({"spins_1": 10}, r"the column spins_2 is missing"),
    "half a shock": (PAIR | {"shock_at": 1, "shock_width": 1}, r"the column shock_force_x is missing"),
    "shape": ({"spins": np.ones((4, 3))}, r"column spins must be numbers, of shape \(n, 2\).*not of shape \(4, 3\)"),
    "text": ({"spins_1": ["a"], "spins_2": 1}, r"the column spins_1 must be numbers, one per scene"),
    "a part": (PAIR | {"rotor": Rotor()}, r"'rotor' is no column of scenes"),
    "no rows": ({"spins_1": [], "spins_2": 1}, r"the table has no rows"),
    "a bad row": ({"spins": (1, 1), "axes_1x": [0, 0, 0.1]}, r"scene 2: Scene: axes\[0\] has length"),
    "half a row": (PAIR | {"rates_1x": [0, np.nan]}, r"scene 1: Scene: rates\[0\]\[0\] = nan"),
    "half a shock in a row": (
        PAIR | {"shock_force": (1, 0, 0), "shock_at": [1, np.nan], "shock_width": 1},
        r"scene 1: Shock: at = nan",
    ),
    "no scene": ([SCENES[0], 5], r"not 5"),
    "a scene alone": (SCENES[0], r"sweep: scenes must be a sequence of at least one Scene"),
    "an empty iterator": (iter([]), r"the iterator has no chunk"),
    "a text": ("scenes", r"sweep: scenes must be .* not 'scenes'"),
    "a later chunk": (iter([SCENES, {"spins": (1, 1), "axes_1x": [0, 0.1]}]), r"scene 10: Scene: axes\[0\] has length"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_anything_else_is_refused_in_words(name: str) -> None:
    scenes, says = REFUSED[name]
    with pytest.raises(InputError, match=says):
        sweep(scenes, T)
