"""`make reader` builds the reader's edition into reader/: a folder that any browser opens from disk, without a network.

    python docs/edition/build.py [DIR]

Pyodide comes from the npm registry, sympy, mpmath and latex2mathml from the package index, in the versions named here; npm and
node are needed to build, nothing to read. Python's modules are compiled by the Python that will run them.
"""

import gzip
import json
import shutil
import subprocess
import sys
import tomllib
import zipfile
from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from printed import examples_of

from lagrotor.about import __version__
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.formulas.font import font_face
from lagrotor.report.job.steps import audit_in_processes

HERE, ROOT = Path(__file__).parent, Path(__file__).parents[2]
INPUTS = ROOT / ".cache" / "edition"
PYODIDE = "314.0.7"
WHEELS = ("sympy==1.14.0", "mpmath==1.3.0", "latex2mathml==3.81.1")
# Of sympy: what `import sympy` and lagrotor's rooms do without.
UNNEEDED = ("physics", "stats", "holonomic", "parsing/autolev", "parsing/latex", "parsing/c", "parsing/fortran")
# What of lagrotor derives and decides.
ROOMS = ("algebra", "mechanics", "paper", "numerics", "report/formulas")
MOST = 20_000_000  # bytes
_COMPILE = """
import { loadPyodide } from "pyodide";
const python = await loadPyodide();
python.FS.mkdirTree("/tree");
python.FS.mount(python.FS.filesystems.NODEFS, { root: process.argv[2] }, "/tree");
python.runPython(`
import ast, importlib.util, marshal, pathlib
for file in pathlib.Path("/tree").rglob("*.py"):
    tree = ast.parse(file.read_bytes())
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, clean=False):
            node.body[0].value.value = ""
    code = compile(tree, str(file.relative_to("/tree")), "exec", dont_inherit=True)
    head = importlib.util.MAGIC_NUMBER + (1).to_bytes(4, "little") + bytes(8)  # not compared with a source
    file.with_suffix(".pyc").write_bytes(head + marshal.dumps(code))
`);
"""


def fetch_inputs() -> tuple[Path, Path]:
    """The folder of Pyodide, and a folder with the wheels unpacked."""
    INPUTS.mkdir(parents=True, exist_ok=True)
    (INPUTS / "package.json").write_text('{"private": true, "type": "module"}', encoding="utf-8")
    run("npm", "install", "--no-audit", "--no-fund", "--silent", f"pyodide@{PYODIDE}", cwd=INPUTS)
    wheels = INPUTS / "wheels"
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet")
    run(*pip, "download", "--no-deps", "--only-binary", ":all:", "--dest", str(wheels), *WHEELS)
    tree = INPUTS / "tree"
    shutil.rmtree(tree, ignore_errors=True)
    for wheel in sorted(wheels.glob("*.whl")):
        zipfile.ZipFile(wheel).extractall(tree)
    return INPUTS / "node_modules" / "pyodide", tree


def run(*command: str, cwd: Path | None = None) -> None:
    """Run a program; its words are shown where it fails."""
    subprocess.run(command, cwd=cwd, check=True, stdout=subprocess.DEVNULL)


def packages(tree: Path) -> bytes:
    """The modules, compiled without their docstrings, as a zip; of lagrotor also the sources from which it reads its names."""
    parts = (tree / "sympy" / part for part in UNNEEDED)
    for unneeded in [*tree.rglob("tests"), *tree.rglob("benchmarks"), *tree.glob("*.data"), tree / "isympy.py", *parts]:
        shutil.rmtree(unneeded) if unneeded.is_dir() else unneeded.unlink(missing_ok=True)
    own = tree / "lagrotor"
    for room in ROOMS:
        # The papers' own modules, and proofs for Coq, are not needed.
        without = shutil.ignore_patterns("__pycache__", "rotor_pair", "certificates", "fonts")
        shutil.copytree(ROOT / "lagrotor" / room, own / room, ignore=without)
    for file in (*(ROOT / "lagrotor").glob("*.py"), ROOT / "lagrotor/report/__init__.py"):
        shutil.copy(file, own / file.relative_to(ROOT / "lagrotor"))
    shutil.copy(HERE / "answers.py", tree)
    script = INPUTS / "compile.mjs"
    script.write_text(_COMPILE, encoding="utf-8")
    run("node", str(script), str(tree.resolve()), cwd=INPUTS)
    target = INPUTS / "packages.zip"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_STORED) as packed:
        for file in sorted(tree.rglob("*")):
            names = file.name == "__init__.py" and own in file.parents
            compiled = file.suffix == ".py" and file.with_suffix(".pyc").exists() and not names
            unneeded_too = (
                ".dist-info" in file.parent.name and file.name != "METADATA"
            )  # latex2mathml reads its version
            if file.is_file() and not compiled and not unneeded_too:
                packed.writestr(zipfile.ZipInfo(file.relative_to(tree).as_posix()), file.read_bytes())
    return target.read_bytes()


def licences(pyodide: Path, tree: Path) -> Iterator[str]:
    """The licences of what the folder holds."""
    yield (ROOT / "LICENSE").read_text(encoding="utf-8")
    for folder in sorted(tree.glob("*.dist-info")):
        for file in sorted(folder.rglob("*LICENSE*")):
            yield f"{folder.name.partition('-')[0]}\n\n{file.read_text(encoding='utf-8')}"
    about = json.loads((pyodide / "package.json").read_text(encoding="utf-8"))
    yield f"Pyodide {about['version']} and CPython, {about['license']} and PSF-2.0: https://github.com/pyodide/pyodide"
    yield (ROOT / "lagrotor/report/formulas/fonts/OFL.txt").read_text(encoding="utf-8")


def examples() -> dict[str, list[dict[str, str]]]:
    """What the forms begin with, the paper's equations last."""
    audit = audit_in_processes(PAPER, lambda _: None) or PAPER.audit()
    held = tomllib.loads((HERE / "examples.toml").read_text(encoding="utf-8"))
    return held | {"judge": [*held["judge"], *examples_of(PAPER, audit)]}


def page(lock: dict[str, Any], files: list[str], forms: dict[str, list[dict[str, str]]]) -> str:
    """The page with its style and its scripts."""

    def part(name: str) -> str:
        return (HERE / name).read_text(encoding="utf-8")

    worker = part("worker.js").replace("LOCK", json.dumps(json.dumps(lock)))
    known = {"FILES": files, "EXAMPLES": forms, "WORKER": worker}
    script = "".join(f"const {name} = {json.dumps(value)};\n" for name, value in known.items()) + part("page.js")
    style = (ROOT / "lagrotor/report/page/page.css").read_text(encoding="utf-8") + part("page.css") + font_face()
    parts = {"/* style */": style, "/* script */": script.replace("</", "<\\/"), "/* version */": __version__}
    text = part("page.html")
    for place, content in parts.items():
        text = text.replace(place, content)
    return text


def build(target: Path) -> int:
    """Write the folder; its size in bytes. Raises SystemExit where it is too large."""
    pyodide, tree = fetch_inputs()
    held = {name: (pyodide / name).read_bytes() for name in ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm")}
    held |= {"python_stdlib.zip": (pyodide / "python_stdlib.zip").read_bytes(), "packages.zip": packages(tree)}
    lock = json.loads((pyodide / "pyodide-lock.json").read_text(encoding="utf-8")) | {"packages": {}}
    shutil.rmtree(target, ignore_errors=True)
    (target / "data").mkdir(parents=True)
    for name, content in held.items():
        text = b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")
        (target / "data" / f"{name}.js").write_text(f'embedded("{name}", "{text}");\n', encoding="utf-8")
    (target / "index.html").write_text(page(lock, list(held), examples()), encoding="utf-8")
    (target / "LICENSES.txt").write_text(f"\n\n{'-' * 78}\n\n".join(licences(pyodide, tree)), encoding="utf-8")
    size = sum(file.stat().st_size for file in target.rglob("*") if file.is_file())
    if size > MOST:
        raise SystemExit(f"{target}: {size / 1e6:.1f} MB are more than {MOST / 1e6:.0f} MB")
    return size


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "reader")
    print(f"{folder / 'index.html'}: {build(folder) / 1e6:.1f} MB")
