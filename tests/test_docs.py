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
def conf() -> ModuleType:
    """docs/conf.py, without the builder that reads it."""
    spec = importlib.util.spec_from_file_location("docs_conf", ROOT / "docs" / "conf.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_reference_has_every_public_name_once(conf: ModuleType) -> None:
    pages = conf.reference()
    shown = "".join(pages.values())
    parts = {path.parent.name for path in (ROOT / "lagrotor").glob("*/__init__.py") if names_of_face(path)}
    assert parts - {"drawing", "pictures"} == conf.PARTS.keys() - {""}, "pictures are drawn by figures/"
    for part in conf.PARTS:
        names = names_of_face(ROOT / "lagrotor" / part / "__init__.py")
        page = pages[f"reference/{part or 'lagrotor'}.rst"]
        listed = {row.rpartition(".")[2] for row in re.findall(r"^   ~?([\w.]+)$", page, re.MULTILINE)}
        assert listed == {name for name, module in names.items() if conf.kind_of(module, name)} and listed
    # `tests/pages.py` asks the built reference for every method; a class shows the methods of its bases.
    assert conf.autodoc_default_options.keys() == {"members", "inherited-members"}
    assert shown.count(".. autofunction:: simulate\n") == shown.count(".. autoclass:: System\n") == 1
    assert not conf.kind_of("lagrotor.models.simulate", "no_such_name")
    assert not re.search(r"`\w+`\w", shown), "a letter after a name in backquotes keeps the quotes from closing"


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("|x| and 2*x", r"\|x\| and 2\*x"),
        ("`a*b` is a * b", r"`a*b` is a \* b"),
        (">>> 2*x", ">>> 2*x"),
        ("lambda_ and r_1", r"lambda\_ and r_1"),
    ],
)
def test_signs_of_formulas_stay_in_the_reference(conf: ModuleType, line: str, shown: str) -> None:
    assert conf.escaped([line]) == [shown]


def test_the_second_paper_is_shown_with_its_verdicts(conf: ModuleType) -> None:
    page = conf.heavy_top()
    assert page.count("| refuted |") == 2 and page.count("| holds |") == 8
    assert r"| 4.1 | threshold of sleep | $\omega_{\min}^2 = \frac{4 m g l I_1}{I_3}$ | refuted |" in page
    assert page.count("```") % 2 == 0 and "weak_gravity = Premise(" in page


def test_the_gallery_has_a_card_for_every_figure_and_system(conf: ModuleType) -> None:
    gallery = conf.gallery()
    systems = list((ROOT / "derivations").glob("g*.py"))
    figures = [path for path in (ROOT / "figures").glob("*.py") if "TITLE" in conf.assigned(path)]
    assert gallery.count('class="card"') == len(systems) + len(figures)
    assert "<span>Corrected trajectories of the pair</span>" in gallery
    assert 'href="report/pages/derivation-g03_heavy_top.html"' in gallery


def test_every_page_of_the_documentation_is_in_a_table_of_contents() -> None:
    pages = {
        path.relative_to(ROOT / "docs").with_suffix("").as_posix()
        for kind in ("*.md", "tutorials/*.ipynb")
        for path in (ROOT / "docs").glob(kind)
    }
    listed = set()
    for index in ("index", "guides", "tutorials/index"):
        text = (ROOT / "docs" / f"{index}.md").read_text(encoding="utf-8")
        tables = re.findall(r"```{toctree}\n(?::.*\n)*\n(.*?)```", text, re.DOTALL)
        place = Path(index).parent
        listed |= {(place / row).as_posix().replace("tutorials/../", "") for table in tables for row in table.split()}
    assert pages - {"index"} <= listed and {"reference/index", "tutorials/index"} <= listed


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
