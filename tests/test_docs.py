"""The documentation is written from the sources: gallery, reference, formulas."""

import ast
import importlib.util
import json
import re
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

import lagrotor
from lagrotor.lazy_imports import names_of_face

ROOT = Path(lagrotor.__file__).parent.parent
pytestmark = pytest.mark.skipif(not (ROOT / "docs").is_dir(), reason="installed without the documentation")


@pytest.fixture(scope="module")
def hooks() -> ModuleType:
    """docs/hooks.py, without the builder that calls it."""
    spec = importlib.util.spec_from_file_location("docs_hooks", ROOT / "docs" / "hooks.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_reference_has_every_public_name(hooks: ModuleType) -> None:
    pages = hooks.reference()
    shown = "".join(pages.values())
    parts = {path.parent.name for path in (ROOT / "lagrotor").glob("*/__init__.py") if names_of_face(path)}
    assert parts - {"drawing", "pictures"} == set(hooks.PARTS), "pictures are drawn by figures/, not by other people"
    for part in ("", *hooks.PARTS):
        names = names_of_face(ROOT / "lagrotor" / part / "__init__.py")
        classes = {f"::: {module}.{name}" for name, module in names.items() if hooks.defines(module, name)}
        assert classes and all(entry in shown for entry in classes)
    assert "::: lagrotor.models.simulate.simulate\n" in pages["reference/lagrotor.md"]
    assert not hooks.defines("lagrotor.models.simulate", "no_such_name")
    # A class shows the methods of its bases: System those of Equations.
    assert "inherited_members: true" in (ROOT / "mkdocs.yml").read_text(encoding="utf-8")


def test_the_second_paper_is_shown_with_its_verdicts(hooks: ModuleType) -> None:
    page = hooks.heavy_top()
    assert page.count("| refuted |") == 2 and page.count("| holds |") == 8
    assert r"| 4.1 | threshold of sleep | $\omega_{\min}^2 = \frac{4 m g l I_1}{I_3}$ | refuted |" in page
    assert page.count("```") % 2 == 0 and "weak_gravity = Premise(" in page


def test_the_gallery_has_a_card_for_every_figure_and_system(hooks: ModuleType) -> None:
    gallery = hooks.gallery()
    systems = list((ROOT / "derivations").glob("g*.py"))
    figures = [path for path in (ROOT / "figures").glob("*.py") if "TITLE" in hooks.assigned(path)]
    assert gallery.count('class="card"') == len(systems) + len(figures)
    assert "<span>Corrected trajectories of the pair</span>" in gallery
    assert 'href="report/pages/derivation-g03_heavy_top.html"' in gallery


def test_formulas_of_the_site_are_typeset_and_code_is_not(hooks: ModuleType) -> None:
    pytest.importorskip("latex2mathml")
    html = hooks.on_page_content("<p>$a^2$ and $$b$$</p><code>$c$</code>", None, None, None)
    assert html.count("<math") == 2 and "<code>$c$</code>" in html


def test_versions_and_extras_agree() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["project"]["version"] == lagrotor.__version__
    assert f"version: {lagrotor.__version__}" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"## {lagrotor.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))["version"] == lagrotor.__version__
    recipe = (ROOT / "conda/meta.yaml").read_text(encoding="utf-8")
    assert f'version = "{lagrotor.__version__}"' in recipe
    needed = [name.replace("matplotlib", "matplotlib-base") for name in project["project"]["dependencies"]]
    needed += project["project"]["optional-dependencies"]["report"]
    assert all(f"- {re.sub('(?=[<>])', ' ', name, count=1)}\n" in recipe for name in needed)
    address = project["project"]["urls"]["Source"]
    assert all(
        address in (ROOT / name).read_text(encoding="utf-8")
        for name in ("CITATION.cff", ".zenodo.json", "conda/meta.yaml")
    )
    declared = [c.rpartition(" ")[2] for c in project["project"]["classifiers"] if "Python :: 3." in c]
    workflow = (ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8")
    assert all(f'"{version}"' in workflow for version in declared) and len(declared) > 2


def test_examples_stand_in_a_section_that_the_reference_shows_as_code() -> None:
    """>>> in the text of a docstring is Markdown's quotation, all on one line."""
    nodes = [
        node for path in (ROOT / "lagrotor").rglob("*.py") for node in ast.walk(ast.parse(path.read_text("utf-8")))
    ]
    texts = [ast.get_docstring(node) or "" for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)]
    shown = [text for text in texts if ">>>" in text]
    assert len(shown) > 5 and [text for text in shown if not re.search(r"^Examples\n-+\n>>>", text, re.MULTILINE)] == []
