"""The documentation is written from the sources: tutorials, gallery, reference; and its builder, where installed, builds it."""

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

import lagrotor

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


def test_the_reference_has_every_public_name_with_its_docstring(hooks: ModuleType) -> None:
    pages = hooks.reference()
    assert all(f"`{name}`" in pages["reference.md"] for name in lagrotor.__all__)
    rooms = {path.name for path in (ROOT / "lagrotor").iterdir() if (path / "__init__.py").is_file()}
    assert {f"reference/{room}.md" for room in rooms} < set(pages)
    assert "### simulate\n" in pages["reference/models.md"]
    said = (lagrotor.simulate.__doc__ or "").strip().splitlines()[0]
    assert said in pages["reference/models.md"]
    assert "#### Run.to_dataframe" in pages["reference/numerics.md"]


def test_the_second_paper_is_shown_with_its_verdicts(hooks: ModuleType) -> None:
    page = hooks.heavy_top()
    assert page.count("| refuted |") == 2 and page.count("| holds |") == 8
    assert r"| 4.1 | threshold of sleep | `\omega_{\min}^2 = \frac{4 m g l I_1}{I_3}` | refuted |" in page
    assert page.count("```") % 2 == 0 and "weak_gravity = Premise(" in page


def test_tutorials_are_the_notebooks_and_the_gallery_the_scripts(hooks: ModuleType) -> None:
    text = hooks.tutorial(ROOT / "docs/notebooks/paired_precession.ipynb")
    assert text.startswith("# The paired precession") and text.count("```python") == text.count("```") / 2
    gallery = hooks.gallery()
    assert "### Corrected trajectories of the pair" in gallery and "derivations/g01" in gallery


def test_versions_and_extras_agree() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["project"]["version"] == lagrotor.__version__
    assert f"version: {lagrotor.__version__}" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"## {lagrotor.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    declared = [c.rpartition(" ")[2] for c in project["project"]["classifiers"] if "Python :: 3." in c]
    workflow = (ROOT / ".github/workflows/tests.yml").read_text(encoding="utf-8")
    assert all(f'"{version}"' in workflow for version in declared) and len(declared) > 2
