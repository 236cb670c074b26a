"""A derivation on the page: its prose, what it proves, and the picture of a run."""

import re
from base64 import b64decode

import pytest

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.page.html_elements import derivation_html, markdown_html, prose, title

PICTURE = r'<img src="data:image/png;base64,([^"]+)" alt="Over time: ([^"]+)">'


def test_a_script_of_the_gallery_is_a_page_with_its_picture() -> None:
    pytest.importorskip("markdown_it")
    script = PAPER.scripts.executed("derivations", "g07_wilberforce")
    html = derivation_html(script, {})
    assert title(script, "g07") == "Wilberforce's pendulum"
    assert "<p><small>Decided exactly: the splitting of the frequencies.</small></p>" in html
    ((data, labels),) = re.findall(PICTURE, html)
    assert b64decode(data).startswith(b"\x89PNG") and len(data) < 80_000
    assert labels.startswith("z, \\vartheta")


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
