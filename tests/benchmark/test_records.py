"""Records say when they were measured, and whether the code that they measured has changed since then."""

import json
from datetime import date
from pathlib import Path
from typing import Any, get_args

import pytest

from lagrotor import numerics
from lagrotor.benchmark import records
from lagrotor.benchmark.records import RecordName, code_digests, record_age, write_record

RENEWAL: dict[RecordName, str] = {
    "speed": "python -m benchmarks.speed",
    "mechanisms": "python -m benchmarks.mechanisms --record",
    "structures": "python -m benchmarks.structure_comparison",
    "bodies_and_lagrangians": "python -m benchmarks.bodies_and_lagrangians --record",
}


def record_of(name: RecordName) -> dict[str, Any]:
    data = json.loads(records.FILES[name].read_text(encoding="utf-8"))
    return {key: data[key] for key in ("date", "digest")}


def test_every_record_has_a_date_and_says_which_code_it_measured() -> None:
    kept = {file.stem.removeprefix("recorded_") for file in Path(records.__file__).parent.glob("recorded_*.json")}
    assert kept == set(get_args(RecordName)) == set(RENEWAL) == set(records.MEASURED_PACKAGES)
    for name in RENEWAL:
        record = record_of(name)
        assert date(2026, 11, 22) <= date.fromisoformat(str(record["date"]))
        if isinstance(record["digest"], dict):  # an older record has none of each package
            assert record["digest"].keys() == code_digests(name).keys()


SOURCE = '"""Words."""\nMOST = 3  # times\n\n\ndef work(x):\n    """Return x."""\n    return MOST * x\n'


@pytest.mark.parametrize(
    ("source", "same"),
    [
        (SOURCE.replace("Words.", "Other words.").replace("# times", "# how often"), True),
        (SOURCE.replace('    """Return x."""\n', ""), True),
        (SOURCE.replace('    """Return x."""\n', '    """Return x.\n\n    Twice.\n    """\n\n'), True),
        (SOURCE.replace("MOST * x", "(MOST*x)"), True),
        (SOURCE.replace("MOST * x", "MOST + x"), False),
        (SOURCE.replace("3", "4"), False),
        (SOURCE.replace("    return", "    'said'\n    return"), True),
        (SOURCE.replace("MOST * x", "'said'"), False),
    ],
)
def test_the_digest_is_of_the_code_and_not_of_its_words(source: str, same: bool, tmp_path: Path) -> None:
    made = []
    for text in (SOURCE, source):
        (tmp_path / "module.py").write_text(text, encoding="utf-8")
        made.append(records._digest(tmp_path))
    assert (made[0] == made[1]) == same


def test_a_kept_program_is_code(tmp_path: Path) -> None:
    made = []
    for text in ("_1 = 2*x", "_1 = 3*x"):
        (tmp_path / "generated.txt").write_text(text, encoding="utf-8")
        made.append(records._digest(tmp_path))
    assert made[0] != made[1]
    assert {file.name for file in Path(numerics.__file__).parent.parent.rglob("generated.txt")} == {
        records.KEPT_SOURCES
    }


def test_a_record_says_which_code_it_measured_and_the_page_what_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(records.FILES, "structures", tmp_path / "recorded.json")
    assert write_record("structures", {"rows": []}) == tmp_path / "recorded.json"
    now = record_of("structures")
    assert now["digest"].keys() == {"mechanics", "numerics", "structures"}
    assert record_age("structures", **now) == f"The measurement is of {now['date']}, with the present code."
    said = "The measurement is of 2026-11-22; "
    other = now["digest"] | {"numerics": "0" * 64}
    changed = record_age("structures", "2026-11-22", other)
    assert changed == f"{said}since then the code of numerics has changed."
    for older in (None, "0" * 64):  # before there were digests, or one of each package
        assert record_age("structures", "2026-11-22", older) == f"{said}the code that it measured is not on record."  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.parametrize("name", RENEWAL)
def test_a_record_is_of_the_present_code_or_is_to_be_renewed(name: RecordName) -> None:
    record = record_of(name)
    if record["digest"] != code_digests(name):
        pytest.xfail(f"{record_age(name, str(record['date']), record['digest'])} Renew it: {RENEWAL[name]}")
