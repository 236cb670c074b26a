"""What a notebook shows of formulas, statements and tests of claims; and that it is decided only then."""

from dataclasses import replace

import sympy as sp

from lagrotor.paper import ClaimTest, Finding, Part, verdict

x = sp.Symbol("x", real=True)


def claim_test(explanation: str) -> ClaimTest:
    finding = Finding((Part("both <i>precess</i>", True), Part("alike", False, "1 < 2")), explanation)
    return ClaimTest("C01", (1, 1), {}, "a model", lambda spins: {"spin": spins[0]}, lambda measured: finding)


def test_what_is_stated_is_shown_as_derived() -> None:
    tex = verdict("5.02", {r"\dot{x}": x**2})._repr_latex_()
    assert "5.02, as derived" in tex and r"\dot{x} = x^{2}" in tex


def test_a_claim_is_shown_with_its_parts_and_the_reason() -> None:
    html = claim_test("<i>so</i>")._repr_html_()
    assert html.index("C01") < html.index("confirmed-if") < html.index("holds only if: 1 &lt; 2")
    assert "both &lt;i&gt;precess&lt;/i&gt;" in html and "&lt;i&gt;so&lt;/i&gt;" in html


def test_a_claim_is_evaluated_once() -> None:
    calls: list[object] = []
    once = replace(claim_test("so"), measure=lambda case: {"runs": len(calls)} if calls.append(case) is None else {})
    assert once.result is once.result
    assert calls == [(1, 1)]
