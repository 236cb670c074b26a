"""What the page begins with is taken from the run: other numbers give other sentences, missing ones none."""

from dataclasses import replace
from pathlib import Path

import pytest

from lagrotor.pair.notation import M, R
from lagrotor.paper import ClaimTest, Finding, Result, Statement, chain, decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.pictures import Picture
from lagrotor.report.content import Report
from lagrotor.report.facts import balance, headlines

MEASURED = {
    "C16": {"corrected_shortest": 1.0811, "corrected_longest": 1.0822},
    "C18": {
        "least_lean_about_joint_line_rad": -0.051,
        "largest_lean_about_joint_line_rad": 0.0712,
        "turned_about_joint_line_without_y_shock_rad": 3.333,
    },
    "C21": {
        "J_over_J_plus_half_m": 0.71421,
        "constant": 0.71432,
        "constant_at_half_the_spins": 0.71443,
        "constant_bar_K_0.1": 0.71454,
        "constant_light_bar": 0.99123,
    },
}
READ_OFF = {
    "19": {
        "paper, largest distance (m)": 0.04712,
        "order_2, largest distance (m)": 0.0077,
        "order_3, largest distance (m)": 0.0013,
    },
    "t6": {
        "cancelling force, second order (N)": -10.61,
        "cancelling force, exact runs (N)": -10.97,
        "exact rate without a force along y (rad/s)": -0.3631,
        "exact rate with the paper's force (rad/s)": 0.0006,
    },
}
SAID = (
    ("it gives 0.7142", "0.7143 at the paper's spins", "0.7144 at half", "0.7145 with a bar", "0.9912 with the light"),
    ("108.1% to 108.2% of its true length", "up to 0.047 m", "0.0077 m at second", "0.0013 m at third"),
    ("-0.363 rad/s", "-10.61 N", "-10.97 N", "between -0.051 and +0.071 rad", "+0.0006 rad/s", "by 3.33"),
)


@pytest.fixture(scope="module")
def report() -> Report:
    rates = {s.id: s for s in PAPER.statements("s5_3a_equal_spins")}
    wrong = Statement("5.22", chain(M, R), correction=chain(M, M))
    claims = tuple(
        Result(
            ClaimTest(i, (1, 1), {}, "", lambda s: {}, lambda v: Finding((), "")),
            v,
            Finding((), ""),
            0,
        )
        for i, v in MEASURED.items()
    )
    pictures = tuple(Picture(key, key, "", "", "", Path(), Path(), read) for key, read in READ_OFF.items())
    return Report(PAPER, (decide(wrong), decide(rates["5.25"])), pictures, (), claims=claims)


def test_numbers_are_those_of_the_run(report: Report) -> None:
    found = headlines(report)
    assert len(found) == len(SAID)
    for headline, parts in zip(found, SAID, strict=True):
        for part in parts:
            assert part in headline.text
    assert found[0].formula == r"c\text{ (equal spins)} = \frac{J}{J + \frac{m R^{2}}{2}}"
    assert [headline.ids for headline in found] == [("5.25", "C21"), ("5.22", "C16", "figure 19"), ("C18", "figure t6")]


def test_another_number_is_another_sentence(report: Report) -> None:
    texts = [headline.text for headline in headlines(report)]
    for i, result in enumerate(report.claims):
        for name, value in result.measured.items():
            other = replace(result, measured={**result.measured, name: value * 1.1})
            changed = replace(report, claims=(*report.claims[:i], other, *report.claims[i + 1 :]))
            assert [headline.text for headline in headlines(changed)] != texts, name


def test_balance_counts_what_was_judged(report: Report) -> None:
    text = balance(report)
    assert text.startswith("0 of 2 equations hold")
    assert (
        "1 is refuted, each with a correction that holds; results of the paper are affected by none of these errors"
        in text
    )
    assert text.endswith("1 is a definition or a measured number. 66 more are not yet judged.")
    alone = decide(Statement("5.20", chain(M, R)))
    text = balance(replace(report, verdicts=(*report.verdicts, alone)))
    assert (
        "2 are refuted; a correction that holds is given for 1 of these; results of the paper are affected by none"
        in text
    )
    held = replace(alone, verdict="holds")
    assert "None is refuted." in balance(replace(report, verdicts=(held,)))
    assert balance(replace(report, verdicts=())) == "None of 68 equations is judged yet."
    open_one = replace(alone, verdict="undecided")
    assert "1 is undecided. 1 is a definition" in balance(replace(report, verdicts=(*report.verdicts, open_one)))
