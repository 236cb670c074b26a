"""A derivation on the page: its prose, what it proves, and the picture of a run."""

import re
from base64 import b64decode
from dataclasses import replace

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report
from lagrotor.report.page.html_elements import derivation_html, markdown_html, prose, title
from lagrotor.report.page.pages import pages
from lagrotor.report.page.sections import derivation_figures
from tests.report.derivation_faults import derivation_faults, faults_of
from tests.report.hostile import long_report, short_report

PICTURE = r'<img src="data:image/png;base64,([^"]+)" alt="Over time: ([^"]+)">'


def test_a_script_of_the_gallery_is_a_page_with_its_picture() -> None:
    pytest.importorskip("markdown_it")
    script = PAPER.scripts.executed("derivations", "g07_wilberforce")
    html = derivation_html(script, {})
    assert title(script, "g07") == "Wilberforce's pendulum"
    assert "<p><small>Decided exactly: the splitting of the frequencies.</small></p>" in html
    ((data, labels),) = re.findall(PICTURE, html)
    assert b64decode(data).startswith(b"\x89PNG") and len(data) < 80_000
    assert labels.startswith("z (m), \\vartheta (rad)")


@pytest.mark.parametrize(
    "text", ["obeys\n$$a = b,$$\nof $x$.", "so\n$$a = 1,\\qquad\nb = 2.$$\nand $x$", "in a line: $$a =\n3$$ (of $x$)"]
)
def test_a_displayed_formula_is_one_wherever_it_stands(text: str) -> None:
    pytest.importorskip("mdit_py_plugins.dollarmath", reason="markdown-it reads the prose")
    html = markdown_html(text)
    assert "$" not in html and html.count('display="block"') >= 1 and "<math><" in html


def test_prose_typesets_what_stands_between_dollars_alone() -> None:
    pytest.importorskip("latex2mathml", reason="latex2mathml sets the formulas")
    formula = "<math><mrow><mi>{}</mi></mrow></math>"
    assert prose("x² of $a$ and $b$, 5") == f"x² of {formula.format('a')} and {formula.format('b')}, 5"


# The derivations that judge equations or claims; the others are looked at where they run.
STEMS = sorted({stem for stem, _ in PAPER.scripts.stating.values()} | set(PAPER.scripts.names("derivations", "c_")))


@pytest.mark.parametrize("stem", STEMS)
def test_a_reader_has_nothing_to_mark(stem: str) -> None:
    assert faults_of(stem) == []


@pytest.mark.parametrize(
    ("html", "fault"),
    [
        ("<h3>Spin</h3>\n<h3>Rate</h3><p>3</p>", "nothing below Spin"),
        ("<h3>Spin</h3>", "nothing below Spin"),
        ("<p><small>Warning of the simulation: off.</small></p>", "warning: Warning of the simulation: off."),
        ("<p>Equilibrium(at={theta: 0})</p>", "Python: m(at="),
        ("<p>the rate 0.78539816339</p>", "Python: 0.785398163"),
        ("<p>the azimuth φ</p><math><mi>ϕ</mi></math>", "φ and ϕ"),
        (r"<p>the azimuth ϕ</p><code>\dot\varphi</code>", "φ and ϕ"),
        ("<p>The rates are:</p><h3>Spin</h3><p>3</p>", "nothing after The rates are:"),
        ("<p> </p>", "an empty paragraph"),
    ],
)
def test_what_a_reader_would_mark_is_seen(html: str, fault: str) -> None:
    assert fault in derivation_faults(html)


def test_a_section_with_its_subsections_is_not_empty() -> None:
    assert derivation_faults("<h3>Rates</h3><h4>Of one rotor</h4><p>The rate is 3 rad/s.</p>") == []


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    return long_report(short_report("text", tmp_path_factory.mktemp("pages")), "text")


JUDGED = '<p class="judged"><a href="#{}">it</a></p>'


@pytest.mark.parametrize(
    ("stem", "inside", "is_drawn"),
    [
        ("s5_2b_pair", JUDGED.format("eq-5.11"), True),  # figure 17 shows 5.11
        ("s5_2b_pair", JUDGED.format("eq-5.09"), False),
        ("t3_stub", "<p>no figure is named</p>", True),  # a figure of the same name
        ("t3_orbit", "<p>Figure 17 shows it</p>", True),
        ("t3_orbit", "<p>Figure 1 shows it</p>", False),
    ],
)
def test_a_derivation_shows_the_figures_that_belong_to_it(
    stem: str, inside: str, is_drawn: bool, report: Report
) -> None:
    assert (report.pictures[0].svg.name in derivation_figures(stem, inside, report)) is is_drawn


def test_the_figures_stand_between_the_notation_and_the_steps(report: Report) -> None:
    inside = "<p>Notation.</p><h3>The series</h3><p>Figure 17 shows it.</p>"
    page = pages(replace(report, derivations=(("t3_orbit", "Orbit", inside),)))["pages/derivation-t3_orbit.html"]
    assert page.index("Notation.") < page.index("../figures/fig17_stub.svg") < page.index("The series")


def test_the_letter_of_the_azimuth_is_one_in_text_and_formula() -> None:
    assert prose(r"phi_1 = 0, so $\phi_2 = 0$ and φ is small").count("ϕ") == 3
