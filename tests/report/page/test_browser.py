"""The page in a real browser: no formula leaves its box, no page is wider than a phone, no script fails.

Needs a Chromium; without one these tests say so and are skipped.
"""

import json
import re
from collections.abc import Iterator
from html import escape, unescape
from pathlib import Path
from typing import Any

import pytest

from lagrotor.paper import Audit
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report, derived_lines
from lagrotor.report.errata import correction_lines
from lagrotor.report.formulas.font import FONT_FAMILY, font_face
from lagrotor.report.formulas.mathml_latex import mathml
from lagrotor.report.page.pages import whole_page
from tests.report.in_browser import dom_of, needs_browser

pytestmark = needs_browser
WIDTHS = (1200, 390)
PAPER_WIDTH = 688  # px, an A4 page without its margins
Seen = dict[str, list[dict[str, Any]]]  # what is measured of each page at each width

# Runs before anything else of the page, so that no failure of its scripts is missed.
LISTENER = """<script>
window.failures = [];
window.addEventListener("error", event => failures.push(String(event.message)));
window.addEventListener("unhandledrejection", event => failures.push(String(event.reason)));
console.error = (...words) => failures.push(words.join(" "));
</script>"""
# A formula is too wide when its block is wider inside than outside; a block that scrolls by itself is told apart.
MEASURE = """
function measure(view) {
  const page = view.document, tooWide = [], scrolled = [];
  for (const fold of page.querySelectorAll("details")) fold.open = true;
  for (const formula of page.querySelectorAll("math")) {
    let box = formula.parentElement;
    while (view.getComputedStyle(box).display.startsWith("inline")) box = box.parentElement;
    if (box.scrollWidth <= box.clientWidth + 1) continue;
    const scrolls = ["auto", "scroll"].includes(view.getComputedStyle(box).overflowX);
    (scrolls ? scrolled : tooWide).push(formula.textContent.slice(0, 60));
  }
  const letters = [...page.querySelectorAll("math :is(mi, mn, mtext)")].filter(letter => letter.textContent.trim());
  const sizes = letters.map(letter => parseFloat(view.getComputedStyle(letter).fontSize));
  return {formulas: page.querySelectorAll("math").length, smallest: Math.min(...sizes), tooWide, scrolled,
          width: page.documentElement.scrollWidth, room: view.innerWidth, failures: view.failures,
          hits: [...page.querySelectorAll("#hits a")].map((hit) => hit.getAttribute("href")),
          hit: page.querySelector("#hits li")?.textContent,
          font: page.fonts.check("16px 'FAMILY'")};
}
window.onload = async () => {
  const views = [...document.querySelectorAll("iframe")].map(frame => frame.contentWindow);
  for (const view of views) {
    await view.document.fonts.ready;
    const query = view.document.getElementById("query");
    if (query) query.value = "5.02";
    query?.dispatchEvent(new Event("input", {bubbles: true}));
  }
  const found = views.map(measure);
  document.body.innerHTML = "<pre id=found></pre>";
  document.getElementById("found").textContent = JSON.stringify(found);
};
""".replace("FAMILY", FONT_FAMILY)


def looked_at(pages: dict[str, str], folder: Path) -> Seen:
    """What the browser finds of each page at each of its widths: a frame of that width, measured after it is drawn."""
    frames = ""
    widths = {name: (PAPER_WIDTH,) if name == "paper" else WIDTHS for name in pages}
    for name, html in pages.items():
        source = escape(html.replace("<head>", "<head>" + LISTENER, 1), quote=True)
        frames += "".join(
            f'<iframe width="{w}" height="900" style="border: 0" srcdoc="{source}"></iframe>' for w in widths[name]
        )
    # Without its encoding the browser guesses, sometimes wrong, and then measures other letters.
    sheet = f'<!DOCTYPE html><meta charset="utf-8">{frames}<script>{MEASURE}</script>'
    shown = dom_of(sheet, folder, "--virtual-time-budget=3000", "--window-size=1300,1000")
    match = re.search(r'<pre id="found">(.*?)</pre>', shown, re.DOTALL)
    assert match, shown[-2000:]
    found = iter(json.loads(unescape(match[1])))
    return {name: [next(found) for _ in widths[name]] for name in pages}


def sheet(formulas: Iterator[str]) -> str:
    """The formulas alone, each in a box as wide as the page's text, with the page's font."""
    style = (
        f"{font_face()} math {{ font: 1.1rem '{FONT_FAMILY}' }} main {{ max-width: 58rem }} div {{ overflow-x: auto }}"
    )
    boxes = "".join(f"<div>{formula}</div>" for formula in formulas)
    view = '<meta name="viewport" content="width=device-width">'
    return f'<!DOCTYPE html><html><head><meta charset="utf-8">{view}<style>{style}</style></head><main>{boxes}</main></html>'


def every_formula(audit: Audit) -> Iterator[str]:
    """The printed equations, and every expression that the derivations state as derived or as a correction."""
    for entry in PAPER.equations.values():
        yield from filter(None, [mathml(entry.latex)])
    for verdict in audit:
        lines = (*derived_lines(verdict.statement.relations), *correction_lines(verdict))
        yield from filter(None, map(mathml, lines))


def wrong() -> str:
    """A formula too wide for a box that does not scroll, one that does, one too small, and a script that fails."""
    long = "<math><mrow>" + "<mi>α</mi><mo>+</mo>" * 99 + "</mrow></math>"
    small = '<p><math style="font-size: 9px"><mi>α</mi></math></p>'
    fails = "<script>console.error('said'); undefined_name()</script>"
    return f"<!DOCTYPE html><html><head></head><p>{long}</p><div style='overflow-x: auto'>{long}</div>{small}{fails}</html>"


@pytest.fixture(scope="module")
def found(audit: Audit, tmp_path_factory: pytest.TempPathFactory) -> Seen:
    """A page, all formulas and what is wrong, looked at together."""
    report = Report(PAPER, tuple(audit[s.id] for s in PAPER.statements("s5_2a_single_rotor")), (), ())
    widest = tuple(v for v in audit if PAPER.equation(v.id).section in ("3", "5.2"))
    paper = whole_page(Report(PAPER, widest, (), ())).replace("@media print", "@media all")
    pages = {"page": whole_page(report), "formulas": sheet(every_formula(audit)), "wrong": wrong(), "paper": paper}
    return looked_at(pages, tmp_path_factory.mktemp("browser"))


def test_the_page_fits_a_desk_and_a_phone(found: Seen) -> None:
    for seen in found["page"]:
        assert seen["formulas"] > 20
        assert seen["font"]
        assert seen["hits"][0] == "#eq-5.02" and len(seen["hits"]) < 9, "the search reads the page itself"
        assert seen["hit"].startswith("5.02 precession rate of one rotor, holds if Condition: I₁ is read as"), seen[
            "hit"
        ]
        assert seen["smallest"] >= 10, "px"
        assert seen["tooWide"] == []
        assert seen["width"] <= seen["room"]
        assert seen["failures"] == []


def test_no_formula_scrolls_on_a_desk(found: Seen) -> None:
    pytest.importorskip("latex2mathml", reason="latex2mathml reads the printed formulas")
    desk, phone = found["formulas"]
    assert desk["formulas"] == phone["formulas"] > 190
    assert desk["scrolled"] == []
    assert phone["width"] <= phone["room"]
    assert desk["font"], "the font inside the page is the one that draws"


def test_every_formula_of_the_printed_report_fits_the_paper(found: Seen) -> None:
    (seen,) = found["paper"]
    assert seen["formulas"] > 300 and seen["failures"] == []
    assert seen["width"] <= seen["room"] == PAPER_WIDTH
    assert seen["smallest"] >= 6, "px"


def test_what_is_wrong_is_found(found: Seen) -> None:
    for seen in found["wrong"]:
        assert len(seen["tooWide"]) == len(seen["scrolled"]) == 1
        assert seen["width"] > seen["room"]
        assert seen["smallest"] == 9
        assert len(seen["failures"]) == 2
        assert seen["failures"][0] == "said"
