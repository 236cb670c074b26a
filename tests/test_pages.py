"""A page with every fault that `make test-pages` looks for: each is found."""

import json
import shutil
from pathlib import Path

import pytest

from tests import pages

HEAD = '<!doctype html><html lang="en"><head><title>t</title><link rel="icon" href="data:,"></head><body><main><h1 id="a">t</h1>'
STYLE = """<style>@media (prefers-color-scheme: dark) { .a { color: #eee } }
@media print { .b { color: #eee } }</style>"""
FAULTY = f"""{HEAD}{STYLE}<p style="width: 2000px">x</p><p class="a">dark</p><p class="b">paper</p>
<math style="font-size: 8px"><mi>a</mi></math><img src="data:," width="9" height="9">
<div style="overflow: auto; height: 9px"><p>scrolls<p>and scrolls</div>
<pre>&lt;Figure size 700x300 with 1 Axes&gt;</pre><p>$$V = x$$</p>
<a href="no.html">n</a><a href="#nowhere">m</a><button>A</button><button style="margin-left: -10px">B</button></main>
<script>undefined_name()</script></body></html>"""
WHOLE = f'{HEAD}<a href="#a">up</a></main></body></html>'


def test_every_kind_of_fault_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("playwright", reason="the extra `pages` is not installed")
    pytest.importorskip("axe_core_python", reason="the extra `pages` is not installed")
    if not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))):
        pytest.skip("no chromium, chromium-browser or google-chrome is installed")
    for name, text in (("faulty", FAULTY), ("whole", WHOLE)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "index.html").write_text(text)
    assert pages.main([str(tmp_path / "faulty")]) == 1
    said = capsys.readouterr().out
    kinds = (
        "script: ",
        "letters under 10 px",
        "buttons overlap: A / B",
        "wider than the window",
        "image-alt",
        "1300 px, print, light: color-contrast",
        "390 px, screen, dark: color-contrast",
        "390 px, screen, dark: scrollable-region-focusable",
        "no file",
        "no place",
        "a picture is not shown",
        "a formula is not shown",
    )
    assert [kind for kind in kinds if kind not in said] == [], json.dumps(said)
    assert pages.main([str(tmp_path / "whole")]) == 0


def test_results_that_a_page_does_not_show_are_named(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(FAULTY)
    (tmp_path / "b.html").write_text(WHOLE + "<p>a price of $5 and $$</p>")
    picture, formula = pages.unshown_results(tmp_path, ["a.html", "b.html"])
    assert "a.html: a picture is not shown: &lt;Figure size 700" in picture and "$$V = x$$" in formula


def test_what_is_not_made_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("playwright", reason="the extra `pages` is not installed")
    assert pages.main([str(tmp_path / "none")]) == 2
