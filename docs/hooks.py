"""Pages of the site that are written from the sources as it is built: gallery, reference, contributing, changes."""

import ast
import re
import shutil
import tomllib
from collections.abc import Iterable
from html import escape, unescape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.about import __version__
from lagrotor.lazy_imports import names_of_face

if TYPE_CHECKING:
    from mkdocs.structure.files import Files

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "report"
# The parts of the package with public names for other people's programs.
PARTS = ("mechanics", "paper", "structures", "models", "theory", "pair", "algebra", "numerics", "proofs")


def on_config(config: Any) -> Any:
    """The version in the foot of every page."""
    config.copyright = f"lagrotor {__version__}"
    if config.extra["version"]["provider"] == "none":
        config.copyright += ". For another version check out its tag and run make docs."
    return config


def on_files(files: "Files", config: Any) -> "Files":
    """Add the generated pages to those of the folder."""
    from mkdocs.structure.files import File

    pages = {
        "gallery.md": gallery(),
        "contributing.md": (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"),
        "changelog.md": (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"),
        "own_paper.md": (ROOT / "papers/pendulum/README.md").read_text(encoding="utf-8"),
        "heavy_top.md": heavy_top(),
    }
    pages |= reference()
    for name, text in pages.items():
        files.append(File.generated(config, name, content=text))
    for picture in ("pair.gif", "fig19_corrected_trajectories.png"):
        files.append(File.generated(config, f"figures/{picture}", abs_src_path=str(ROOT / "figures" / picture)))
    return files


def heavy_top() -> str:
    """The second paper: what it is, its equations as printed with the verdicts on record, and a derivation."""
    folder = ROOT / "papers/heavy_top"
    rows = tomllib.loads((folder / "equations.toml").read_text(encoding="utf-8"))["equation"]
    recorded = tomllib.loads((folder / "recorded.toml").read_text(encoding="utf-8"))
    verdicts = {i: row["verdict"] for i, row in recorded.items()}
    lines = [
        f"| {row['id']} | {row['title']} | ${row['latex'].replace('|', ' ')}$ | {verdicts[row['id']]} |" for row in rows
    ]
    table = "\n".join(["| | equation | as printed | verdict |", "|---|---|---|---|", *lines])
    script = (folder / "derivations/s2_precession.py").read_text(encoding="utf-8")
    read = (folder / "README.md").read_text(encoding="utf-8")
    return f"{read}\n## Verdicts\n\n{table}\n\n## Where they come from\n\n```python\n{script}```\n"


def gallery() -> str:
    """A card with its picture for each figure and each textbook system of the report, by its title."""
    parts = ["# Gallery", "![The paired precession](figures/pair.gif)", "## Figures"]
    cards = []
    # The paper's figures first.
    for path in sorted((ROOT / "figures").glob("*.py"), key=lambda path: (not path.stem.startswith("fig"), path.stem)):
        names = assigned(path)
        if "TITLE" in names:
            picture = f"report/figures/{path.stem}.svg"
            cards.append(card(picture, names["TITLE"], names.get("ALT", ""), picture))
    parts += [cards_of(cards), "## Textbook systems"]
    systems = sorted((ROOT / "derivations").glob("g*.py"))
    titles = {path.stem: path.read_text(encoding="utf-8").split("# # ", 1)[1].splitlines()[0] for path in systems}
    pages = {stem: f"report/pages/derivation-{stem}.html" for stem in titles}
    parts.append(cards_of(card(run_picture(stem), title, "", pages[stem]) for stem, title in titles.items()))
    return "\n\n".join(parts)


def cards_of(cards: Iterable[str]) -> str:
    """Cards beside each other."""
    return f'<div class="cards">{"".join(cards)}</div>'


def card(picture: str, title: str, text: str, address: str) -> str:
    """A picture over its title, both a link."""
    image = f'<img src="{picture}" alt="{escape(text)}" loading="lazy">' if picture else ""
    return f'<a class="card" href="{address}">{image}<span>{escape(title)}</span></a>'


def run_picture(stem: str) -> str:
    """The address of the first picture of a run in a derivation's page, which holds it; none where it has no run."""
    page = REPORT / "pages" / f"derivation-{stem}.html"
    held = (
        re.search(r'src="(data:image/png;base64,[^"]+)"', page.read_text(encoding="utf-8")) if page.exists() else None
    )
    return held[1] if held else ""


def assigned(path: Path) -> dict[str, str]:
    """The strings that a script assigns, by name."""
    found = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                value = ast.literal_eval(node.value)
            except ValueError:
                continue
            found |= {node.targets[0].id: value} if isinstance(value, str) else {}
    return found


def reference() -> dict[str, str]:
    """A page for each part of the package that hands on public names, with each of them, and one for the errors."""
    package = ROOT / "lagrotor"
    pages = {"reference/errors.md": "# Errors\n\n::: lagrotor.errors\n    options:\n      show_root_heading: false\n"}
    for part in ("", *PARTS):
        name = f"lagrotor.{part}".rstrip(".")
        names = names_of_face(package / part / "__init__.py")
        entries = [f"::: {module}.{public}" for public, module in sorted(names.items()) if defines(module, public)]
        how = f"Import each name from the package: `from {name} import {min(names)}`." if names else ""
        # A name that is searched for is found here before the pages that only mention it.
        head = f"---\nsearch:\n  boost: 4\n---\n\n# {name}"
        pages[f"reference/{part or 'lagrotor'}.md"] = "\n\n".join([head, how, *entries]) + "\n"
    return pages


def defines(module: str, name: str) -> bool:
    """Whether a module defines a function or a class of this name; what else it hands on is shown by what it is of."""
    tree = ast.parse((ROOT / (module.replace(".", "/") + ".py")).read_text(encoding="utf-8"))
    return any(isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name == name for node in tree.body)


def on_page_content(html: str, page: Any, config: Any, files: "Files") -> str:
    """Formulas between dollars, typeset; what is code stays as it is."""
    from lagrotor.report.formulas.mathml_latex import mathml

    parts = re.split(r"(<(?:pre|code|script|style)\b.*?</(?:pre|code|script|style)>)", html, flags=re.DOTALL)
    for i in range(0, len(parts), 2):
        parts[i] = re.sub(r"\$\$(.+?)\$\$", lambda m: mathml(unescape(m[1])) or m[0], parts[i], flags=re.DOTALL)
        parts[i] = re.sub(r"\$([^$<>]+?)\$", lambda m: mathml(unescape(m[1]), display=False) or m[0], parts[i])
    return "".join(parts)


def on_post_template(output: str, template_name: str, config: Any) -> str:
    """The page for an address that does not exist, treated as any other."""
    return on_post_page(output, None, config) if template_name.endswith(".html") else output


def on_post_page(output: str, page: Any, config: Any) -> str:
    """What the theme leaves out for a keyboard and for a screen reader."""
    output = output.replace(
        'data-md-component="search" role="dialog"', 'data-md-component="search" role="dialog" aria-label="Search"'
    )
    return output.replace('class="highlight-ipynb hl-python"', 'class="highlight-ipynb hl-python" tabindex="0"')


def on_post_build(config: Any) -> None:
    """The report beside the documentation, without its durations; the reader's edition where it is made."""
    if REPORT.is_dir():
        without = shutil.ignore_patterns("times.json")
        shutil.copytree(REPORT, Path(config.site_dir) / "report", ignore=without)
    if (ROOT / "reader").is_dir():
        shutil.copytree(ROOT / "reader", Path(config.site_dir) / "reader")
