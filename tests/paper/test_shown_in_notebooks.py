"""What a notebook shows of formulas, statements and tests of claims; and that it is decided only then."""

from dataclasses import replace

import pytest
import sympy as sp

from lagrotor.paper import ClaimTest, Finding, Part, Remark, Statement, chain, decide, verdict

x = sp.Symbol("x", real=True)
HOLDS = Statement("5.01", chain(sp.sin(x) ** 2, 1 - sp.cos(x) ** 2))
WRONG = Statement("5.02", chain(x, -x), wrong="The sign is <b>lost</b>.", correction=chain(x, x))


def claim_test(explanation: str) -> ClaimTest:
    finding = Finding((Part("both <i>precess</i>", True), Part("alike", False, "1 < 2")), explanation)
    return ClaimTest("C01", (1, 1), {}, "a model", lambda spins: {"spin": spins[0]}, lambda measured: finding)


def test_a_verdict_is_shown_with_what_is_wrong_and_its_correction() -> None:
    assert ">holds<" in decide(HOLDS)._repr_html_()
    html = decide(WRONG)._repr_html_()
    assert html.index("5.02: ") < html.index(">refuted<br>")
    assert "the correction: holds" in html
    assert "The sign is &lt;b&gt;lost&lt;/b&gt;." in html


def test_what_is_stated_is_shown_as_derived() -> None:
    tex = verdict("5.02", {r"\dot{x}": x**2})._repr_latex_()
    assert "5.02, as derived" in tex and r"\dot{x} = x^{2}" in tex


def test_a_claim_is_shown_with_its_parts_and_the_reason() -> None:
    html = claim_test("<i>so</i>")._repr_html_()
    assert html.index("C01") < html.index("confirmed-if") < html.index("holds only if: 1 &lt; 2")
    assert "both &lt;i&gt;precess&lt;/i&gt;" in html and "&lt;i&gt;so&lt;/i&gt;" in html


def test_nothing_is_measured_before_it_is_shown() -> None:
    def decided(_: object) -> None:
        raise AssertionError

    waiting = replace(claim_test("so"), decide=decided)
    with pytest.raises(AssertionError):
        waiting._repr_html_()


def test_a_claim_is_evaluated_once() -> None:
    calls: list[object] = []
    once = replace(claim_test("so"), measure=lambda case: {"runs": len(calls)} if calls.append(case) is None else {})
    assert once.result is once.result
    assert calls == [(1, 1)]


def test_a_remark_is_shown_under_its_heading() -> None:
    assert Remark("Twist", "it grows")._repr_markdown_() == "**Twist.** it grows"
