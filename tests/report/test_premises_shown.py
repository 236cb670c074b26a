"""The premises that the scripts give to the ledger are those that a reader gets: in the shell, page, data and errata."""

from dataclasses import replace

import pytest

from lagrotor.paper import Audit, Premise, Verdict, decide
from lagrotor.paper.audit import in_words, verdict_data
from lagrotor.paper.readable import readable
from lagrotor.paper.rotor_pair.own_paper import PAPER
from lagrotor.report.content import Report
from lagrotor.report.errata import errata, latex_document
from lagrotor.report.facts import facts
from lagrotor.report.latex import latex_prose
from lagrotor.report.page.pieces import prose
from lagrotor.report.page.sections import equation_entry, erratum_entry
from lagrotor.report.text_forms import errata_sheet


@pytest.fixture(scope="module")
def report(audit: Audit) -> Report:
    return Report(PAPER, tuple(audit), (), ())


def given(verdict: Verdict) -> list[Premise]:
    """The premises under which the ledger was to judge: the script's, and the values that the catalogue has for a line."""
    scenes = [premise for relation in verdict.statement.relations for premise in relation.scene_premises]
    return [*verdict.statement.premises, *scenes]


def says(premises: list[Premise]) -> set[str]:
    return {premise.says for premise in premises}


def test_every_refuted_line_is_stated_under_all_premises_that_its_script_gives(report: Report) -> None:
    assert len(report.verdicts) == 68
    for verdict in report.verdicts:
        assumed = says(list(verdict.refuted_under))
        if verdict.verdict != "refuted":
            assert not assumed
            continue
        wrong = [line for line in verdict.lines if line.verdict == "refuted"]
        scenes = [premise for line in wrong for premise in line.relation.scene_premises]
        assert assumed == says([*verdict.statement.premises, *scenes]), verdict.id
        assert all(
            premise.says in says(list(line.premises)) for line in wrong for premise in verdict.statement.premises
        )


def test_what_agrees_shows_given_premises_only_and_an_order_its_small_quantity(report: Report) -> None:
    for verdict in report.verdicts:
        for line in verdict.lines:
            if line.verdict != "refuted":
                small = {premise.says for premise in line.premises if premise.small == line.small is not None}
                assert says(list(line.premises)) <= says(given(verdict)) | small, verdict.id


def shown_premises(verdict: Verdict) -> list[Premise]:
    return [*verdict.refuted_under, *verdict.premises]


def test_shell_page_and_data_show_the_premises_of_all_equations(report: Report) -> None:
    for verdict in report.verdicts:
        premises, data = shown_premises(verdict), verdict_data(verdict, PAPER)
        shell, page = in_words(verdict, PAPER), equation_entry(verdict, report)
        fact_texts = " ".join(text for fact in facts(verdict, report) for text in fact.texts)
        assert [p["says"] for p in data["refuted_under"]] == [p.says for p in verdict.refuted_under]
        assert [p["says"] for p in data["premises"]] == [p.says for p in verdict.premises]
        for premise in premises:
            assert readable(premise.with_formula) in shell, verdict.id
            assert premise.sentence in fact_texts and prose(premise.sentence) in page, verdict.id
        assert ("stated if" in shell) == ("Error as stated if" in page) == bool(verdict.refuted_under), verdict.id


def test_errata_in_three_forms_show_the_premises_of_every_refuted_equation(report: Report) -> None:
    markdown, tex = errata_sheet(report), latex_document(report.verdicts, PAPER)
    rows = {e.id: e for e in errata(report.verdicts, PAPER)}
    sheets = dict(zip(rows, markdown.split("### Erratum ")[1:], strict=True))
    items = dict(zip(rows, tex.split(r"\item ")[1:], strict=True))
    for verdict in report.verdicts:
        for premise in shown_premises(verdict) if verdict.verdict == "refuted" else ():
            words = readable(premise.says).replace("|", r"\|").split(":")[0].split("_")[0].split("*")[0]
            assert words in sheets[verdict.id], (verdict.id, premise.says)
            assert prose(premise.sentence) in erratum_entry(rows[verdict.id]), (verdict.id, premise.says)
            number = tex.split(f") {latex_prose(premise.says)}")[0].rpartition("(")[2]
            assert f"({number})" in items[verdict.id], (verdict.id, premise.says)


@pytest.mark.parametrize(
    ("identifier", "words"),
    [
        ("5.20", ["m = K = 0", "ℓ = R"]),
        ("5.21", ["J = I₃", "m = K = 0", "ℓ = R"]),
        ("5.22", ["m = K = 0", "ℓ = R", "R = 1"]),
        ("5.26", ["m = K = 1", "η = 0", "ω₁ = 10, ω₂ = −10"]),
        ("5.27", ["I₁ = I₃ = M = R = ℓ = 1", "m = K = 1"]),
        ("5.28", ["I₁ = I₃ = M = R = ℓ = 1", "m = K = 1"]),
        ("6.02", ["I₁ = I₃ = M = R = ℓ = 1", "m = K = 1"]),
    ],
)
def test_premises_of_the_papers_main_errors(report: Report, identifier: str, words: list[str]) -> None:
    verdict = next(v for v in report.verdicts if v.id == identifier)
    stated = "; ".join(readable(premise.with_formula) for premise in verdict.refuted_under)
    assert all(word in stated for word in words)


def test_another_bar_has_another_difference_and_says_so(report: Report) -> None:
    """Without the premise of a massless bar x₁ does not lack r₀²: the difference is another, and the premise is not shown."""
    verdict = next(v for v in report.verdicts if v.id == "5.22")
    massless, *others = verdict.statement.premises
    changed = decide(replace(verdict.statement, premises=tuple(others), correction=()))
    assert massless.says not in says(list(changed.refuted_under))
    assert str(verdict.lines[0].difference) == "-1" != str(changed.lines[0].difference)


def test_differences_are_in_their_normal_form_and_numbers_in_digits(report: Report) -> None:
    lines = {v.id: [line for line in v.lines if line.verdict == "refuted"] for v in report.verdicts}
    assert [str(line.difference) for line in lines["5.22"]] == ["-1", "1"]
    assert [line.reason.rpartition(" ")[2] for line in lines["5.22"]] == ["−1", "1"]
    assert lines["5.27"][0].reason.endswith("at order 2 in θ, by 0.6797 + 0.09853/q²")
    verdict = next(v for v in report.verdicts if v.id == "5.27")
    assert any("changes by 0.8093 θ²" in text for text in verdict.evidence)
    assert "its digits allow 0.44 %" in lines["5.28"][0].reason
    assert "its digits allow 0.88 %" in lines["5.26"][0].reason
    assert len(str(lines["2.08"][0].difference)) < 100


def test_the_corrected_line_of_5_21_has_a_difference_of_derivatives_where_a_product_is_printed(report: Report) -> None:
    e = next(e for e in errata(report.verdicts, PAPER) if e.id == "5.21")
    assert r"\sin\theta_2} - \frac" in e.corrected[0] and r"\frac{\partial}{\partial" in e.corrected[0]
