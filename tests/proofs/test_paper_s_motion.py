"""Theorems beside the claims, which prove theirs in `tests/paper/test_claims.py`; the numbers of docs/proofs.md."""

import re
import tomllib
from dataclasses import replace
from decimal import Decimal
from importlib.resources import files
from pathlib import Path

import pytest
import sympy as sp

pytest.importorskip("flint", reason="the extra `proof` is not installed")

from lagrotor import Scene, Structure, natural_rate, precession_orbit
from lagrotor.proofs import check, crossing, no_crossing, precession


def test_the_precession_of_figure_21_turns_more_slowly_than_the_printed_rate() -> None:
    """The paper takes the natural rate (8 rad/s, massless bar) at every amplitude; the corrected series is right."""
    scene = Scene((10, -10))
    orbit, corrected = precession(scene, 0.204), precession_orbit(scene, 0.204, 1e-9)
    assert natural_rate(scene) == pytest.approx(8) and orbit.frequency < 8
    assert abs(float(orbit.frequency.mid()) - corrected.frequency) <= corrected.frequency_error + 1e-14
    page = (Path(__file__).parents[2] / "docs" / "proofs.md").read_text(encoding="utf-8")
    assert "7.9181412672010302" in page and "7.9181412672010302" in orbit.summary()["frequency [rad/s]"]


def test_the_numbers_of_the_page_are_those_on_record() -> None:
    """Each decimal of a claim's row is in its theorems on record, to within one of its last digit."""
    page = (Path(__file__).parents[2] / "docs" / "proofs.md").read_text(encoding="utf-8")
    record = tomllib.loads((files("lagrotor.paper.rotor_pair") / "recorded.toml").read_text(encoding="utf-8"))
    decimals = re.compile(r"\d+\.\d+")

    def stands(number: str, claim: str) -> bool:
        known = map(Decimal, decimals.findall(" ".join(record[claim]["theorems"])))
        return any(abs(x - Decimal(number)) <= Decimal(1).scaleb(-len(number.partition(".")[2])) for x in known)

    rows = re.findall(r"^\| (C\d\d): [^|]*\| (.*) \|$", page, re.MULTILINE)
    assert len(rows) == sum("theorems" in x for x in record.values() if isinstance(x, dict))
    assert not [(claim, x) for claim, said in rows for x in decimals.findall(said) if not stands(x, claim)]
    assert not stands("1.244", "C02") and not stands("16.185", "C20")


@pytest.mark.slow
def test_the_corner_falls_at_its_resonance_and_equal_spins_do_not() -> None:
    """At 1.0607 of its critical spins, pushed by 0.1 of its natural rate, a corner passes 26°; with equal spins it does not."""
    corner = Structure(joints=[(0, 0), (1, 0), (1, 1)], bars=[(0, 1), (1, 2)], spins=[1, 0, 1], gravity=9.81, load=2.0)
    push = [("0.0409", "-0.252"), ("0.0409", "-0.0403"), ("0.0555", "-0.0403")]  # rad/s, on the bars
    tilt = sp.Symbol("z_0", real=True) - sp.Rational(9, 10)

    def at_the_factor(spins: list[int]) -> Structure:
        one = replace(corner, spins=spins)
        turns = sp.Rational(str(round(1.0607 * one.critical_spin(), 6)))
        return replace(one, spins=[turns * spin for spin in spins])

    fall = crossing(at_the_factor([1, 0, 1]), v0=push, event=tilt, t_end="6.3")
    assert fall.first and "first passes zero" in check(fall.certificate)
    assert no_crossing(at_the_factor([1, 1, 1]), v0=push, event=tilt, t_end="6.3").theorem
