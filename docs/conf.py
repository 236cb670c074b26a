"""The documentation, built by Sphinx. Gallery, reference and the second paper are written from the sources as it is built."""

import ast
import os
import re
import shutil
import tomllib
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any

from lagrotor.about import __version__
from lagrotor.lazy_imports import names_of_face

ROOT = Path(__file__).parent.parent
REPORT = ROOT / "report"
# The packages with public names for other programs, and what each is for.
PARTS = {
    "": "The pair: scenes, runs, closed forms",
    "mechanics": "Any mechanical system",
    "paper": "Any paper's equations",
    "structures": "Rotors and bars",
    "models": "Models, sweeps and orbits of the pair",
    "theory": "Closed forms of the pair",
    "pair": "The pair in symbols",
    "algebra": "Exact decisions",
    "numerics": "Integration and errors",
    "proofs": "Theorems about motion",
}

project, author, release = "lagrotor", "The lagrotor developers", __version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.intersphinx", "numpydoc", "myst_nb"]
exclude_patterns = ["edition", "_build"]
html_theme = "pydata_sphinx_theme"
html_title = f"lagrotor {release}"
html_context = {"default_mode": "auto"}  # light or dark as the system; without it the first page writes an error
html_static_path = ["site.css", "site.js"]
html_favicon = "icon.svg"
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_sidebars = {page: [] for page in ("index", "gallery", "contributing", "changelog")}
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"show_prev_next": False, "navigation_with_keys": False, "secondary_sidebar_items": ["page-toc"]}
default_role = "py:obj"
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath", "attrs_inline"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_render_markdown_format = "myst"  # of the formulas of a system
autodoc_default_options = {"members": True, "inherited-members": "dict, tuple, list, str, Exception"}
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc's sections have the types
autosummary_generate = False
numpydoc_show_class_members = False
intersphinx_mapping = {
    name: (address, None)
    for name, address in {
        "python": "https://docs.python.org/3",
        "numpy": "https://numpy.org/doc/stable",
        "scipy": "https://docs.scipy.org/doc/scipy",
        "sympy": "https://docs.sympy.org/latest",
    }.items()
    if os.environ.get(
        "LAGROTOR_ONLINE"
    )  # only where their servers can be reached: a failure is a warning, which is an error
}


def setup(app: Any) -> None:
    """Write the generated pages before Sphinx reads, typeset formulas as MathML, and put the report beside the pages."""
    app.connect("builder-inited", lambda app: write_pages())
    app.connect("autodoc-process-docstring", escape_docstring, priority=100)  # before numpydoc adds markup
    app.connect("build-finished", lambda app, error: error or copy_report(Path(app.outdir)))
    app.add_html_math_renderer("mathml", (inline_formula, None), (displayed_formula, None))


def inline_formula(translator: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    from lagrotor.report.formulas.mathml_latex import mathml

    translator.body.append(mathml(node.astext(), display=False) or f"<code>{escape(node.astext())}</code>")
    raise SkipNode


def displayed_formula(translator: Any, node: Any) -> None:
    from docutils.nodes import SkipNode

    from lagrotor.report.formulas.mathml_latex import mathml

    translator.body.append(f"<div>{mathml(node.astext()) or escape(node.astext())}</div>")
    raise SkipNode


def write_pages() -> None:
    """Write the gallery, the page of the second paper and the folder `reference`, which git ignores."""
    pages = {"gallery.md": gallery(), "heavy_top.md": heavy_top()} | reference()
    for name, text in pages.items():
        file = ROOT / "docs" / name
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def copy_report(site: Path) -> None:
    """Copy the report without its durations, and the reader's edition where it is made, beside the documentation."""
    if REPORT.is_dir():
        shutil.copytree(REPORT, site / "report", ignore=shutil.ignore_patterns("times.json"), dirs_exist_ok=True)
    if (ROOT / "reader").is_dir():
        shutil.copytree(ROOT / "reader", site / "reader", dirs_exist_ok=True)


def reference() -> dict[str, str]:
    """Return {file: page}: for each package a table of its public names, then each name with its methods.

    A name of two packages is explained on the page of the first; the other page links to it.
    """
    rows = "\n".join(f"   {part or 'lagrotor'}" for part in (*PARTS, "errors"))
    index = f"Reference\n=========\n\n.. toctree::\n   :maxdepth: 1\n\n{rows}\n"
    errors = "Errors\n======\n\n.. automodule:: lagrotor.errors\n"
    pages, explained = {"reference/index.rst": index, "reference/errors.rst": errors}, dict[tuple[str, str], str]()
    for part, says in PARTS.items():
        name = f"lagrotor.{part}".rstrip(".")
        face = ROOT / "lagrotor" / part / "__init__.py"
        title, opening = f"{says}: {name}", ast.get_docstring(ast.parse(face.read_text(encoding="utf-8"))) or ""
        own, listed = list[str](), list[str]()
        for public, module in sorted(names_of_face(face).items()):
            if kind := kind_of(module, public):
                first = explained.setdefault((module, public), f"{name}.{public}")
                here = first == f"{name}.{public}"
                listed.append(f"   {public if here else '~' + first}")
                own += [f".. auto{kind}:: {public}"] if here else []
        table = ".. autosummary::\n   :nosignatures:\n\n" + "\n".join(listed)
        blocks = [f"{title}\n{'=' * len(title)}", f".. py:module:: {name}", text_of(opening), table, *own]
        pages[f"reference/{part or 'lagrotor'}.rst"] = "\n\n".join(blocks) + "\n"
    return pages


def escape_docstring(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Keep the signs |, * and _ of formulas in a docstring, which is plain text with names in single backquotes."""
    lines[:] = escaped(lines)


def escaped(lines: Iterable[str]) -> list[str]:
    """Return lines of text with a backslash before |, * and an _ at the end of a word, except in names between backquotes and in
    examples."""
    sign = re.compile(r"(`[^`]*`)|([|*]|(?<=\w)_(?!\w))")
    return [
        line if line.lstrip().startswith((">>>", "...")) else sign.sub(lambda m: m[1] or f"\\{m[2]}", line)
        for line in lines
    ]


def text_of(docstring: str) -> str:
    """Return a package's docstring; the lines of an indented table stay lines."""
    return "\n".join(
        re.sub(r"^ +(?=\S)", "| ", line) if line.startswith("    ") else line
        for line in escaped(docstring.splitlines())
    )


def kind_of(module: str, name: str) -> str:
    """Return "function" or "class" for a name that the module defines so, and "" for any other."""
    tree = ast.parse((ROOT / (module.replace(".", "/") + ".py")).read_text(encoding="utf-8"))
    kinds = {ast.FunctionDef: "function", ast.ClassDef: "class"}
    return next((kinds[type(node)] for node in tree.body if type(node) in kinds and node.name == name), "")


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
    parts = ["# Gallery", "![The paired precession](../figures/pair.gif)", "## Figures"]
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
