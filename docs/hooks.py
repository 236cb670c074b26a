"""Pages of the site that are written from the sources as it is built: tutorials, gallery, reference, contributing, changes."""

import ast
import json
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.faces import names_of_face

if TYPE_CHECKING:
    from mkdocs.structure.files import Files

ROOT = Path(__file__).parent.parent


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
    pages |= {f"tutorials/{path.stem}.md": tutorial(path) for path in sorted((ROOT / "docs/notebooks").glob("*.ipynb"))}
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
    lines = [f"| {row['id']} | {row['title']} | `{row['latex']}` | {verdicts[row['id']]} |" for row in rows]
    table = "\n".join(["| | equation | as printed | verdict |", "|---|---|---|---|", *lines])
    script = (folder / "derivations/s2_precession.py").read_text(encoding="utf-8")
    read = (folder / "README.md").read_text(encoding="utf-8")
    return f"{read}\n## Verdicts\n\n{table}\n\n## Where they come from\n\n```python\n{script}```\n"


def tutorial(path: Path) -> str:
    """A notebook as Markdown."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    texts = ("".join(cell["source"]) for cell in cells)
    return "\n\n".join(
        text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```"
        for cell, text in zip(cells, texts, strict=True)
    )


def gallery() -> str:
    """The textbook systems by their titles, and the figures by title and description, read off the scripts."""
    parts = ["# Gallery", "![The paired precession](figures/pair.gif)"]
    parts += ["![Corrected trajectories](figures/fig19_corrected_trajectories.png)", "## Textbook systems"]
    systems = sorted((ROOT / "derivations").glob("g*.py"))
    titles = ((path.stem, path.read_text(encoding="utf-8").split("# # ", 1)[1].splitlines()[0]) for path in systems)
    parts += ["\n".join(f"- {title} (`derivations/{stem}.py`)" for stem, title in titles), "## Figures"]
    for path in sorted((ROOT / "figures").glob("*.py")):
        names = assigned(path)
        if "TITLE" in names:
            parts.append(f"### {names['TITLE']}\n\n{names.get('ALT', '')}\n\n`lagrotor figure`: `figures/{path.name}`")
    return "\n\n".join(parts)


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
    """The reference: the names at the top of the package, then a page a room, with every public docstring."""
    package = ROOT / "lagrotor"
    rooms = sorted(path.name for path in package.iterdir() if (path / "__init__.py").is_file())
    top = ", ".join(f"`{name}`" for name in sorted(names_of_face(package / "__init__.py")))
    listed = "\n".join(f"- [{room}](reference/{room}.md)" for room in rooms)
    pages = {"reference.md": f"# Reference\n\nFrom the top of the package: {top}.\n\nRoom by room:\n\n{listed}\n"}
    for room in rooms:
        modules = [module(path) for path in sorted((package / room).rglob("*.py"))]
        pages[f"reference/{room}.md"] = "\n\n".join([f"# lagrotor.{room}", *filter(None, modules)])
    return pages


def module(path: Path) -> str:
    """A module's docstring, and its public functions and classes with theirs."""
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    parts = [f"## {name}", fenced(ast.get_docstring(tree))]
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            parts += [f"### {node.name}", fenced(called(node) + "\n\n" + (ast.get_docstring(node) or ""))]
            for inner in node.body if isinstance(node, ast.ClassDef) else []:
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_") and ast.get_docstring(inner):
                    parts += [
                        f"#### {node.name}.{inner.name}",
                        fenced(called(inner) + "\n\n" + (ast.get_docstring(inner) or "")),
                    ]
    return "\n\n".join(filter(None, parts)) if len(parts) > 2 else ""


def called(node: ast.FunctionDef | ast.ClassDef) -> str:
    """How a name is called."""
    if isinstance(node, ast.ClassDef):
        fields = [ast.unparse(n.target) for n in node.body if isinstance(n, ast.AnnAssign)]
        return f"class {node.name}({', '.join(fields)})"
    return f"{node.name}({ast.unparse(node.args)})"


def fenced(text: str | None) -> str:
    """A docstring as it is: its lines and formulas are its own."""
    return f"```text\n{text.strip()}\n```" if text else ""
