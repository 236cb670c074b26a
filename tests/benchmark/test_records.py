"""Records say when they were measured, and whether the code that they measured has changed since then."""

import json
from datetime import date
from pathlib import Path
from types import SimpleNamespace
from typing import get_args

import pytest

from lagrotor.benchmark import records
from lagrotor.benchmark.records import RecordName, code_digest, record_age, stamp

RENEWAL: dict[RecordName, str] = {
    "speed": "python -m benchmarks.speed",
    "mechanisms": "python -m benchmarks.mechanisms --record",
    "structures": "python -m benchmarks.structure_comparison",
    "bodies_and_lagrangians": "python -m benchmarks.bodies_and_lagrangians --record",
}


def record_of(name: RecordName) -> dict[str, str | None]:
    data = json.loads(Path(records.__file__).with_name(f"recorded_{name}.json").read_text(encoding="utf-8"))
    return {key: data[key] for key in ("date", "digest")}


def test_every_record_has_a_date_and_a_digest() -> None:
    kept = {file.stem.removeprefix("recorded_") for file in Path(records.__file__).parent.glob("recorded_*.json")}
    assert kept == set(get_args(RecordName)) == set(RENEWAL) == set(records.MEASURED_PACKAGES)
    for name in RENEWAL:
        record = record_of(name)
        assert date(2026, 11, 22) <= date.fromisoformat(str(record["date"]))
        assert record["digest"] is None or len(str(record["digest"])) == 64


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
def test_the_digest_is_of_the_code_and_not_of_its_words(
    source: str, same: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = SimpleNamespace(__path__=[str(tmp_path)], __name__="lagrotor.numerics")
    monkeypatch.setitem(records.MEASURED_PACKAGES, "speed", (package,))
    made = []
    for text in (SOURCE, source):
        (tmp_path / "module.py").write_text(text, encoding="utf-8")
        code_digest.cache_clear()
        made.append(stamp("speed")["digest"])
    code_digest.cache_clear()
    assert (made[0] == made[1]) == same


def test_the_page_says_whether_the_code_has_changed() -> None:
    now = stamp("structures")
    assert record_age("structures", **now) == f"The measurement is of {now['date']}, with the present code."
    for digest in ("0" * 64, None):  # another code; a record that is older than the digest
        said = (
            "The measurement is of 2026-11-22; the code that it measured (mechanics, numerics, structures) has changed"
        )
        assert record_age("structures", "2026-11-22", digest) == f"{said} since then."


@pytest.mark.slow
@pytest.mark.parametrize("name", RENEWAL)
def test_a_record_is_of_the_present_code_or_is_to_be_renewed(name: RecordName) -> None:
    record = record_of(name)
    if record["digest"] != code_digest(name):
        pytest.xfail(f"{record_age(name, str(record['date']), record['digest'])} Renew it: {RENEWAL[name]}")
