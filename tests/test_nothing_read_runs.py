"""What is read as data, and any text that is parsed, calls nothing: each door is tried with what leaves a trace where it runs."""

import ast
import json
import pickle
import re
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from html.parser import HTMLParser
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
import pytest
import sympy as sp

import lagrotor
from lagrotor import Scene, Sweep, Trajectory, read_scene, sweep
from lagrotor.commands.command_line import main
from lagrotor.errors import LagrotorError
from lagrotor.files import read_arrays
from lagrotor.mechanics import System, coordinates
from lagrotor.numerics.run import read_run
from lagrotor.numerics.source_cache import GeneratedFunction
from lagrotor.paper import Glossary, Paper, Premise, judge
from lagrotor.paper.catalogue import section_glossary
from lagrotor.paper.latex.check import check_source
from lagrotor.paper.latex.displays import read_source
from lagrotor.paper.latex.init import begin_paper, confirm
from lagrotor.paper.latex.stated_system import write_derivation
from lagrotor.paper.papers import opened
from lagrotor.proofs.coq.certificate import PREAMBLE
from lagrotor.proofs.coq.coq_check import CERTIFICATE_LIST, foreign_word, read_certificates
from lagrotor.report.job import cache as report_cache
from lagrotor.report.page.html_elements import markdown_html
from lagrotor.structures import read_structure

ROOT = Path(lagrotor.__file__).parent
x, m = sp.symbols("x m", positive=True)


def python(mark: Path) -> list[str]:
    """Texts that leave the mark when Python evaluates or runs them, or a script in which they stand in a comment, a string."""
    call = f"__import__('pathlib').Path({str(mark)!r}).touch()"
    return [call, f'"); {call} #', f"L at \r# %%\r{call}", f"x\n# %%\n{call}\n", f'"""\n{call}\n"""', f"{{{call}}}"]


def tex(mark: Path) -> list[str]:
    """Texts with which TeX, and a shell, would leave the mark."""
    return [rf"\write18{{touch {mark}}}", rf'\input{{|"touch {mark}"}}', rf"\directlua{{os.execute('touch {mark}')}}"]


ROBOT = """<robot name="«r»"><link name="«a»"/><link name="b"><inertial><origin xyz="«0 0 0»"/><mass value="«1»"/>
<inertia ixx="«1»" iyy="1" izz="1"/></inertial></link><joint name="«j»" type="«revolute»"><parent link="a"/><child link="b"/>
</joint>«»</robot>"""
MJCF = """<mujoco model="«m»"><compiler angle="«radian»"/><default><joint damping="«1»"/></default><worldbody><body name="«b»">
<joint name="«q»"/><geom size="«1»"/></body></worldbody><equality><joint name="«e»" joint1="q" polycoef="«0»"/></equality>
</mujoco>"""


def variants(template: str, text: str, quoted: bool = True) -> Iterator[str]:
    """The template, in which «…» is what may stand otherwise, with the text in the place of one after the other."""
    pieces = re.split("«(.*?)»", template)
    for place in range(1, len(pieces), 2):
        yield "".join([*pieces[:place], json.dumps(text)[1:-1] if quoted else text, *pieces[place + 1 :]])


# ---- the doors: what is done with a text that would run

PAPER = """title = "«T»"
authors = ["«A»"]
results = ["«1.1»"]
equations_in = "«s»"
claims_in = "«c»"
model = "«»"
letters = ["«x»"]
preamble = "«»"
[sections]
1 = "«S»"
"«2»" = "other"
[notation]
"«x»" = "«real»"
[[opening]]
label = "«l»"
text = "«{equations} t»"
[[headline]]
title = "«t»"
text = "«{1.1}»"
ids = ["«1.1»"]
formula = "«1.1»"
[system]
coordinates = "«x»"
L = "«x_dot**2/2 - x**2/2»"
constraints = ["«x - 1»"]
[system.derives]
"1.1" = "«energy»"
"«1.2»" = "L"
"""
EQUATIONS = """[letters.1]
"real" = "«y z»"
"«vector»" = "r"
[units.1]
"«m»" = "«y»"
[[equation]]
id = "«1.1»"
section = "«1»"
title = "«t»"
latex = "«x»"
reading = "«x»"
letters = { "«w»" = "«y»" }
[[equation.line]]
quantity = "«E»"
members = ["«y»", "«z»"]
small = "«y»"
read_off = "«1.0»"
scene = { "«y»" = "«1»" }
"""
CLAIMS = '[[claim]]\nid = "«C01»"\nsection = "1"\ntext = "«t»"\nequations = ["«1.1»"]\n'
FIGURES = '[[figure]]\nnumber = 1\nsection = "«1»"\ntitle = "«t»"\nequations = ["«1.1»"]\n'
RECORD = '["1.1"]\nverdict = "«holds»"\nlines = ["«E: holds»"]\n["«1.2»"]\nverdict = "holds"\n'
PLAIN = {
    "paper.toml": 'title = "T"\nequations_in = "s"\n[sections]\n1 = "S"\n',
    "equations.toml": "\n".join(
        f'[[equation]]\nid = "{i}"\nsection = "1"\ntitle = "t"\nlatex = "x"\n'
        '[[equation.line]]\nquantity = "E"\nmembers = ["1"]\n'
        for i in ("1.1", "1.2")
    ),
}


def use_paper(folder: Path) -> None:
    """All that is done with a paper's folder: read, judged, its system derived and that derivation judged."""
    paper = Paper(folder)
    for part in (lambda: paper.recorded, paper.audit, lambda: write_derivation(paper), Paper(folder).audit):
        with suppress(LagrotorError):
            part()
    for identifier in paper.equations:
        with suppress(LagrotorError):
            paper.lines(identifier)
        with suppress(LagrotorError):
            section_glossary(paper, paper.equation(identifier).section)


def paper_file(name: str, template: str) -> Callable[[Path, str], None]:
    def door(folder: Path, text: str) -> None:
        for number, content in enumerate(variants(template, text)):
            paper = folder / str(number)
            paper.mkdir()
            for file, plain in (PLAIN | {name: content}).items():
                (paper / file).write_text(plain, encoding="utf-8")
            with suppress(LagrotorError):
                use_paper(paper)

    return door


TEX = r"""\documentclass{article}\title{«T»}\author{«A»}\newcommand{\a}{«x»}
\begin{document}\section{«S»}In «words» we have $«y» = 1$.
\begin{equation}\label{«e»} \a_{«1»} + \mathrm{«b»} = «c» \end{equation}
\begin{equation} \mathbf{«r»} = \frac{d «q»}{d t} \tag{«7»} \end{equation}\input{«file»}\end{document}
"""


def source_file(suffix: str, template: str) -> Callable[[Path, str], None]:
    def door(folder: Path, text: str) -> None:
        for number, content in enumerate(variants(template, text, quoted=False)):
            source = folder / f"{number}{suffix}"
            source.write_text(content, encoding="utf-8")
            source.with_suffix(".aux").write_text(rf"\newlabel{{e}}{{{{{text}}}{{1}}}}" + rf"\@input{{{text}}}")
            with suppress(LagrotorError):
                check_source(read_source(source))
            for _ in range(2):  # a new folder, and the same made again
                with suppress(LagrotorError):
                    begin_paper(folder / f"paper {number}", source)
            with suppress(LagrotorError):
                paper = Paper(folder / f"paper {number}")
                confirm(paper.folder, [i for i, each in paper.equations.items() if each.line])
            with suppress(LagrotorError):
                use_paper(folder / f"paper {number}")

    return door


def judged(folder: Path, text: str) -> None:
    """A text as each argument of `judge`, of the shell's, and as a value where an expression is asked for."""
    for given in (
        {"printed": text},
        {"derived": text},
        {"given": [text]},
        {"given": [{x: text}]},
        {"given": [{text: x}]},
        {"small": text},
    ):
        with suppress(LagrotorError):
            judge(**({"printed": x, "derived": x} | given))
    with suppress(LagrotorError):
        Premise("words", {x: text})
    for options in ([f"x = {text}"], [text], ["x = y", "--given", text]):
        assert main(["judge", *options]) in (0, 1, 2)


def units(folder: Path, text: str) -> None:
    with suppress(LagrotorError):
        Glossary().letter("x", "a letter", text)
    with suppress(LagrotorError, ValueError):
        Glossary().letter(text, "a letter", "m")


def system_text(folder: Path, text: str) -> None:
    """A text as a letter's name in what is generated and run, and as every value that a system is given."""
    with suppress(LagrotorError, ValueError):
        c = coordinates(text)
        System(c, c.v[0] ** 2 / 2 - c.q[0] ** 2 / 2).simulate({}, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1))
    strange = sp.Symbol(text, positive=True)
    c = coordinates("x")
    (q,), (v,) = c.q, c.v
    own = System(c, strange * v**2 / 2 - q**2 / 2)
    with suppress(LagrotorError):
        own.simulate({strange: 1.0}, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1))
    called = sp.Function(text)
    with suppress(LagrotorError):
        System(c, v**2 / 2 - called(q)).simulate({called: (np.sin, np.cos)}, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1))
    system = System(c, m * v**2 / 2 - q**2 / 2)
    values: dict[Any, Any] = {m: text}
    for use in (
        lambda: System(c, text),
        lambda: System(c, v**2, constraints=[text]),
        lambda: System(c, v**2, dissipation=text),
        lambda: System(c, v**2, forces=[text]),
        lambda: system.simulate(values, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1)),
        lambda: system.simulate({m: 1}, q0=(text,), v0=(0.0,), t=(0.0, 0.1)),
        lambda: system.simulate({text: 1}, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1)),
        lambda: system.linearise({q: text}, values),
        lambda: system.equilibria(values=values),
        lambda: system.equilibria(values={m: 1}, box={q: (text, text)}),
        lambda: system.floquet({q: 0}, values, 1.0),
        lambda: system.root_locus({q: 0}, {m: 1}, text, [1, 2]),
        lambda: system.hamiltonian().normal_form({q: text}),
        lambda: system.lindstedt_poincare(2, text),
        lambda: system.simulate({m: 1}, q0=(0.1,), v0=(0.0,), t=(0.0, 0.1)).plot(text),
    ):
        with suppress(LagrotorError, sp.SympifyError, TypeError, AttributeError, ValueError):
            use()


SCENE = 'spins = ["«1»", 2]\n"«link»" = "«none»"\n[rotor]\n"«mass»" = "«1»"\n[shock]\nforce = ["«1»", 2, 3]\n'
STRUCTURE = 'joints = [["«0»", 0], [1, 0]]\nbars = [["«0»", 1]]\n"«spins»" = ["«1»"]\n[rotor]\nmass = "«1»"\n'


def document(name: str, template: str, read: Callable[[Path], Any], command: list[str]) -> Callable[[Path, str], None]:
    def door(folder: Path, text: str) -> None:
        for content in variants(template, text):
            file = folder / name
            file.write_text(content, encoding="utf-8")
            with suppress(LagrotorError):
                read(file)
        assert main([*command, str(file)]) == 2

    return door


def robot_file(folder: Path, text: str) -> None:
    """Attributes and elements of URDF and MJCF, which may name the symbols, and reach the formulas that the shell prints."""
    for name, template in (("m.urdf", ROBOT), ("m.xml", MJCF)):
        for content in (escape(text, {'"': "&quot;", "\n": "&#10;"}), text):
            for inside in variants(template, content, quoted=False):
                (folder / name).write_text(inside, encoding="utf-8")
                with suppress(LagrotorError):
                    System.from_urdf(folder / name) if name == "m.urdf" else System.from_mjcf(folder / name)
                assert main(["equations", str(folder / name), "--format", "latex"]) in (0, 2)


def certificates(folder: Path, text: str) -> None:
    """The list of a folder of certificates, and what stands in a file of Coq."""
    row = {"id": "«1.1»", "verdict": "«holds»", "file": "«equation_1_1.v»"}
    row["lines"] = [{"name": "«line_1»", "quantity": "«x»", "verdict": "«holds»", "theorems": ["«line_1»"]}]
    (folder / "equation_1_1.v").write_text(PREAMBLE)
    for content in variants(json.dumps([row], ensure_ascii=False), text):
        (folder / CERTIFICATE_LIST).write_text(content, encoding="utf-8")
        with suppress(LagrotorError):
            read_certificates(folder)
    for sentence in (f'Redirect "{folder}/ran" Print nat.', "Load ran.", 'Declare ML Module "ran".', "- Drop."):
        assert foreign_word(f"{PREAMBLE}\nTheorem line_1 : 0 = 0.\nProof. {sentence}\nQed.")


def theorem(folder: Path, text: str) -> None:
    """A certificate of a theorem about motion, with the text for each of its operations, numbers and words."""
    pytest.importorskip("flint", reason="python-flint is not installed")
    checking = import_module("lagrotor.proofs.checker.checking")
    claim = {"kind": "crossing", "r0": [text, text], "stability": text}
    motion = {"operations": [[text, 0], ["add", 0, text]], "numbers": [text]}
    for made in ({"claim": claim, "motion": motion, "steps": [text]}, {"claim": text}, {text: text}, [text]):
        with suppress(LagrotorError, KeyError, TypeError, AttributeError, IndexError):
            checking.check(json.loads(json.dumps(made)))


TEXTS: dict[str, Callable[[Path, str], None]] = {
    "paper.toml": paper_file("paper.toml", PAPER),
    "equations.toml": paper_file("equations.toml", EQUATIONS),
    "claims.toml": paper_file("claims.toml", CLAIMS),
    "figures.toml": paper_file("figures.toml", FIGURES),
    "recorded.toml": paper_file("recorded.toml", RECORD),
    "LaTeX": source_file(".tex", TEX),
    "judge": judged,
    "units": units,
    "system": system_text,
    "scene": document("scene.toml", SCENE, read_scene, ["simulate", "--scene"]),
    "structure": document("structure.toml", STRUCTURE, read_structure, ["structure"]),
    "robot file": robot_file,
    "certificates": certificates,
    "theorem": theorem,
}


@pytest.mark.parametrize("door", TEXTS)
@pytest.mark.filterwarnings("ignore")
def test_no_text_runs(door: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark = tmp_path / "ran"
    monkeypatch.chdir(tmp_path)
    for number, text in enumerate([*python(mark), *tex(mark)]):
        folder = tmp_path / str(number)
        folder.mkdir()
        TEXTS[door](folder, text)
        assert not mark.exists(), text


def test_each_text_leaves_its_trace_where_it_does_run(tmp_path: Path) -> None:
    mark = tmp_path / "ran"

    def trace(run: Callable[[], Any]) -> None:
        with suppress(Exception):
            run()
        assert mark.exists()
        mark.unlink()

    call, in_call, after_return, after_line, in_docstring, in_braces = python(mark)
    trace(lambda: eval(call))
    trace(lambda: sp.sympify(call))
    trace(lambda: exec(f'print("{in_call}")'))
    trace(lambda: exec(f"# {after_return}"))
    trace(lambda: exec(f"# {after_line}"))
    trace(lambda: exec(f'"""{in_docstring}"""'))
    trace(lambda: eval(f"f'''{in_braces}'''"))
    for text in tex(mark):
        trace(lambda text=text: subprocess.run(re.search(r"touch [^'\"}]+", text)[0], shell=True, check=True))  # type: ignore[index]


# ---- files of arrays and of products


class Call:
    """What a hostile pickle holds: a function and its arguments."""

    def __init__(self, function: Any, *arguments: Any) -> None:
        self.function, self.arguments = function, arguments

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return self.function, self.arguments

    def __call__(self) -> None:
        """Pickle asks whether what it is to call can be called."""


def test_no_product_of_the_cache_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Pickles and Python in the place of a product; the twin is `pickle.loads`."""
    monkeypatch.setattr(report_cache, "cache_folder", lambda: tmp_path / "cache")
    mark, cache = tmp_path / "ran", report_cache.Cache(opened((ROOT.parent / "papers" / "pendulum").resolve()))
    cache.keep("claim C01", "inputs", 1)
    (file,) = (tmp_path / "cache").rglob("*.json")
    source = f"def f(): pass\n{python(mark)[0]}"
    for call in (Call(eval, python(mark)[0]), Call(Call(GeneratedFunction, np.str_, ()), source)):
        for text in (pickle.dumps(call), *(text.encode() for text in python(mark))):
            file.write_bytes(text)
            assert cache.take("claim C01", "inputs") is None
        assert not mark.exists()
        with suppress(Exception):
            pickle.loads(pickle.dumps(call))
        assert mark.exists()
        mark.unlink()


def test_no_file_of_arrays_runs(tmp_path: Path) -> None:
    """The twin is numpy, told to read objects."""
    mark, file = tmp_path / "ran", tmp_path / "run.npz"
    objects = np.empty(1, object)
    objects[0] = Call(eval, python(mark)[0])
    doors = (read_arrays, read_run, Trajectory.load)
    for held in ({"about": objects}, {"about": np.array("{}"), "t": objects}):
        np.savez(file, **held)
        for door in doors:
            with suppress(LagrotorError):
                door(file)
            assert not mark.exists()
        with np.load(file, allow_pickle=True) as loaded, suppress(Exception):
            _ = [loaded[name] for name in loaded]
        assert mark.exists()
        mark.unlink()


def test_no_folder_of_a_sweep_runs(tmp_path: Path) -> None:
    """Pickles and Python in every file of the folder; the twin is numpy, told to read objects."""
    mark, folder = tmp_path / "ran", tmp_path / "out"
    sweep([Scene((10, -10))], [0.0, 0.1], folder=folder)
    objects = np.empty(1, object)
    objects[0] = Call(eval, python(mark)[0])
    np.save(tmp_path / "objects.npy", objects, allow_pickle=True)
    texts = [(tmp_path / "objects.npy").read_bytes(), *(text.encode() for text in python(mark))]
    for file in sorted(folder.iterdir()):
        kept = file.read_bytes()
        for text in texts:
            file.write_bytes(text)
            with suppress(LagrotorError):
                _ = [np.asarray(getattr(Sweep.open(folder), name)) for name in ("axes", "errors", "models")]
            assert not mark.exists(), file.name
        file.write_bytes(kept)
    np.load(tmp_path / "objects.npy", allow_pickle=True)
    assert mark.exists()


# ---- pages


class Page(HTMLParser):
    """What in a page would run, or lead to what runs."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.runs: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.runs += [tag] if tag in ("script", "iframe", "object", "embed") else []
        for name, value in attrs:
            address = "".join((value or "").split()).lower()
            if name.startswith("on") or address.startswith(("javascript:", "vbscript:", "data:text/html")):
                self.runs.append(f"{name}={value}")


HTML = [
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "[x](javascript:alert(1))",
    "<javascript:alert(1)>",
    "![x](javascript:alert(1))",
    r"$\href{javascript:alert(1)}{x}$",
    r"$\text{<img src=x onerror=alert(1)>}$",
    '"><script>alert(1)</script>',
    "</title></script><script>alert(1)</script>",
]


@pytest.mark.parametrize("text", HTML)
def test_nothing_in_a_papers_texts_runs_in_its_page(text: str, tmp_path: Path) -> None:
    from lagrotor.report.page.html_elements import prose, typeset

    shown = [markdown_html(text), prose(text), typeset(text.strip("$"))]
    shown += [Scene(spins=(1.0, -1.0))._repr_html_(), judge(sp.Symbol(text), sp.Symbol(text) + 1)._repr_html_()]
    assert [Page(html).runs for html in shown] == [[]] * len(shown)


def test_what_would_run_in_a_page_is_seen() -> None:
    for html in (HTML[0], HTML[1], '<a href="java\nscript:x">', HTML[-2], HTML[-1], '<a href="data:text/html,x">'):
        assert Page(html).runs


# ---- that these are all the doors

# What reads or runs, in each module, and the door above behind which it stands; "own": what lagrotor itself wrote or ships,
# "program": a paper's derivations, figures and letters, which are programs and are run when they are asked for.
READERS = {
    "benchmark/records.py": "own",
    "commands/command_line.py": "own",
    "commands/paper_commands.py": "LaTeX",
    "drawing/film.py": "own",
    "drawing/view.py": "own",
    "lazy_imports.py": "own",
    "files.py": "arrays",
    "mechanics/robot_files/xml_elements.py": "robot file",
    "mechanics/running/exports.py": "own",
    "mechanics/running/simulation.py": "arrays",
    "models/spring_link/run.py": "arrays",
    "models/sweeps/sweep_folder.py": "sweeps",
    "numerics/run.py": "arrays",
    "numerics/source_cache.py": "system",
    "pair/scene_document.py": "scene",
    "pair/trajectory.py": "arrays",
    "paper/catalogue.py": "program",
    "paper/record.py": "recorded.toml",
    "paper/scripts.py": "program",
    "paper/latex/displays.py": "LaTeX",
    "paper/latex/numbers.py": "LaTeX",
    "paper/latex/init.py": "LaTeX",
    "paper/latex/token_stream.py": "LaTeX",
    "paper/theorems.py": "theorem",
    "proofs/coq/coq_check.py": "certificates",
    "renamed.py": "own",
    "report/content.py": "own",
    "report/formulas/font.py": "own",
    "report/page/interactive.py": "own",
    "report/job/cache.py": "products",
    "report/job/folder.py": "own",
    "report/job/dependencies.py": "program",
    "report/job/reproduce.py": "products",
    "report/job/steps.py": "paper.toml",
    "report/page/pages.py": "own",
    "report/page/html_elements.py": "own",
    "structures/exact/structure_run.py": "arrays",
}
_NAMES = {
    "eval",
    "exec",
    "compile",
    "open",
    "toml",
    "import_module",
    "__import__",
    "parse_expr",
    "parse_latex",
    "Popen",
}
_NAMES |= {"read_text", "read_bytes", "read_toml", "read_arrays", "read_run", "read_source", "frombuffer", "fromfile"}
_MODULES = {("json", "load"), ("json", "loads"), ("pickle", "load"), ("pickle", "loads"), ("tomllib", "load")}
_MODULES |= {("tomllib", "loads"), ("np", "load"), ("subprocess", "run"), ("os", "system"), ("runpy", "run_path")}


def reads_or_runs(tree: ast.AST) -> bool:
    """Whether a module has a call of one of these."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute):
            *_, owner, last = ("", *ast.unparse(node.func).split("."))
            if (owner, last) in _MODULES or (last in _NAMES and owner not in ("re", "macros", "scaled")):
                return True
    return False


def parses_text(tree: ast.AST) -> bool:
    """Whether a module calls sympify, or hands it on, so that it would take a text."""
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    strict = {id(call.func) for call in calls if any(k.arg == "strict" for k in call.keywords)}
    names = (node for node in ast.walk(tree) if isinstance(node, ast.Attribute | ast.Name) and id(node) not in strict)
    return any((node.attr if isinstance(node, ast.Attribute) else node.id) == "sympify" for node in names)


def modules_that(have: Callable[[ast.AST], bool], words: str) -> set[str]:
    """Modules of lagrotor, of those in which one of the words stands."""
    texts = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in ROOT.rglob("*.py")}
    return {name for name, text in texts.items() if re.search(words, text) and have(ast.parse(text))}


def test_every_module_that_reads_or_runs_stands_behind_a_door() -> None:
    words = "|".join([*_NAMES, *(name for name, _ in _MODULES)])
    assert modules_that(reads_or_runs, rf"\b({words})\b") == set(READERS)
    assert set(READERS.values()) - set(TEXTS) == {"own", "program", "arrays", "products", "sweeps"}
    assert reads_or_runs(ast.parse("pickle.loads(b'')")) and not reads_or_runs(ast.parse("re.compile('x')"))


def test_sympify_takes_no_text_anywhere() -> None:
    assert modules_that(parses_text, "sympify") == set()
    assert parses_text(ast.parse("sp.sympify(x)")) and parses_text(ast.parse("map(sympify, x)"))
    assert not parses_text(ast.parse("sp.sympify(x, strict=True)"))
