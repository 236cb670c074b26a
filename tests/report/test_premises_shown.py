"""The premises that the scripts give to the ledger are those that a reader gets: in the shell, page, data and errata."""

import re

import pytest

from lagrotor.paper import Audit, Premise, Verdict
from lagrotor.paper.audit import in_words, verdict_data
from lagrotor.paper.plain_text import readable, readable_on_page
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report
from lagrotor.report.errata import errata, latex_document, letter_table, premise_text
from lagrotor.report.facts import facts
from lagrotor.report.latex import latex_prose
from lagrotor.report.page.html_elements import prose
from lagrotor.report.page.sections import equation_entry
from lagrotor.report.page.sections import errata_sheet as sheet_of_page
from lagrotor.report.text_forms import errata_sheet


@pytest.fixture(scope="module")
def report(audit: Audit) -> Report:
    return Report(PAPER, tuple(audit), (), ())


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
        assert ("stated if" in shell) == ("Premises of the error" in page) == bool(verdict.refuted_under), verdict.id


def number_in(markdown: str, words: str) -> str:
    """The number, such as P3, of the premise that begins with these words."""
    return markdown.split(f":** {words}")[0].rpartition("**")[2]


def test_errata_in_three_forms_show_the_premises_of_every_refuted_equation(report: Report) -> None:
    markdown, tex = errata_sheet(report), latex_document(report.verdicts, PAPER)
    page, rows = sheet_of_page(report), [e.id for e in errata(report.verdicts, PAPER)]
    entries = dict(zip(rows, page.split("<article id=")[1:], strict=True))
    sheets = dict(zip(rows, markdown.split("### Erratum ")[1:], strict=True))
    items = dict(zip(rows, tex.split(r"\item ")[1:], strict=True))
    for verdict in report.verdicts:
        for premise in shown_premises(verdict) if verdict.verdict == "refuted" else ():
            words = readable_on_page(premise.says).replace("|", r"\|").split(":")[0].split("_")[0].split("*")[0]
            assert f"**{number_in(markdown, words)}:**" in markdown
            assert re.search(rf"\b{number_in(markdown, words)}\b", sheets[verdict.id]), (verdict.id, premise.says)
            place = page.split(f":</b> {prose(premise_text(premise))}.")[0].rpartition('id="')[2].partition('"')[0]
            assert f'<a href="#{place}">P{place.removeprefix("premise-")}</a>' in entries[verdict.id], premise.says
            number = tex.split(f": {latex_prose(premise.says)}")[0].rpartition("\n")[2]
            assert re.search(rf"\b{number}\b", items[verdict.id]), (verdict.id, premise.says)


def test_errata_in_html_have_the_letters_of_the_other_forms(report: Report) -> None:
    page = sheet_of_page(report)
    rows = letter_table(errata(report.verdicts, PAPER), PAPER)
    assert len(rows) > 40 and page.count("<tr>") == len(rows) + 1
    for tex, meaning, _, ids in rows:
        assert f'<th scope="row">{prose(f"${tex}$")}</th><td data-head="Meaning">{prose(meaning)}</td>' in page
        assert f'<td data-head="In">{ids}</td>' in page


def test_differences_are_in_their_normal_form_and_numbers_in_digits(report: Report) -> None:
    lines = {v.id: [line for line in v.lines if line.verdict == "refuted"] for v in report.verdicts}
    assert [str(line.difference) for line in lines["5.22"]] == ["-1", "1"]
    assert [line.reason.rpartition(" ")[2] for line in lines["5.22"]] == ["−1", "1"]
    assert lines["5.27"][0].reason.endswith("order 2 in θ has the coefficient 0.6797 + 0.09853/q²")
    verdict = next(v for v in report.verdicts if v.id == "5.27")
    assert any("changes by 0.8093 θ²" in text for text in verdict.evidence)
    assert "its digits allow 0.44 %" in lines["5.28"][0].reason
    assert "its digits allow 0.88 %" in lines["5.26"][0].reason
    assert len(str(lines["2.08"][0].difference)) < 100
