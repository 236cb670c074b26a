"""The house as CONTRIBUTING.md draws it: every import runs downward, no room and no module lies on a circle."""

import ast
import re
import tomllib
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

from lagrotor.lazy_imports import names_of_face

ROOT = Path(__file__).parent.parent
# From the ground up: a room imports from those before it and from itself. A part of a room may have its floor.
FLOORS = (
    *(
        "about",
        "errors",
        "files",
        "process_settings",
        "renamed",
        "lazy_imports",
        "formula_text",
        "result_display",
        "algebra",
        "numerics",
        "drawing",
        "mechanics",
        "pair",
        "theory",
        "models",
        "structures",
        "benchmark",
        "proofs",
    ),
    *("paper", "proofs.coq", "pictures", "", "report", "commands"),  # "": the face of the package, which hands names on
)
ROOMS = [room for room in FLOORS if room and "." not in room]
# A leaf: a paper's theorems are verified by it, the claims prove theirs, and commands and report make certificates.
LEAF = "lagrotor.proofs"
ABOVE_THE_LEAF = ("paper.theorems", "paper.rotor_pair.claims", "commands", "report.job")


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in sorted((ROOT / "lagrotor").rglob("*.py"))}


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    return tuple(ast.walk(ast.parse(path.read_text())))


def imported(path: Path) -> set[str]:
    """Modules of the package that a file imports, wherever in it; by absolute names, which a test below asks for."""
    found: set[str] = set()
    for node in nodes(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                found.add(inner if inner in MODULES else node.module)
    return {name for name in found if name in MODULES}


@pytest.fixture(scope="module")
def imports() -> dict[str, set[str]]:
    return {name: imported(path) for name, path in MODULES.items()}


def floor(module: str) -> int | None:
    """How high the room of a module lies; None for `__main__`."""
    _, *parts = module.split(".")
    part, room = ".".join(parts[:2]), ".".join(parts[:1])
    return FLOORS.index(part if part in FLOORS else room) if room in FLOORS else None


def upward(imports: dict[str, set[str]]) -> list[str]:
    return [
        f"{name} imports {other}"
        for name, others in imports.items()
        for other in sorted(others)
        if (here := floor(name)) is not None and ((there := floor(other)) is None or there > here)
    ]


def into_the_leaf(imports: dict[str, set[str]]) -> list[str]:
    """Modules that import a leaf of the house, though they are none of the few that may."""
    allowed = (LEAF, *(f"lagrotor.{each}" for each in ABOVE_THE_LEAF))
    return [
        name
        for name, others in imports.items()
        if any(other.startswith(LEAF) for other in others) and not name.startswith(allowed)
    ]


def circles(imports: dict[str, set[str]]) -> list[set[str]]:
    """Sets of more than one module that reach each other."""

    def reach(start: str) -> set[str]:
        seen: set[str] = set()
        left = [start]
        while left:
            for other in imports[left.pop()]:
                if other not in seen:
                    seen.add(other)
                    left.append(other)
        return seen

    reached = {name: reach(name) for name in imports}
    return [{a, b} for a in imports for b in reached[a] if a < b and a in reached[b]]


def test_every_room_has_its_floor() -> None:
    rooms = {
        path.stem for path in (ROOT / "lagrotor").iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert rooms - {"__init__", "__main__"} == set(ROOMS)


def test_no_import_runs_upward(imports: dict[str, set[str]]) -> None:
    assert upward(imports) == []


def test_only_claims_and_certificates_import_the_proofs(imports: dict[str, set[str]]) -> None:
    assert into_the_leaf(imports) == []
    changed = imports | {"lagrotor.structures.structure": {"lagrotor.proofs.checker.checking"}}
    assert into_the_leaf(changed) == ["lagrotor.structures.structure"]


def development_imports(file: Path) -> list[str]:
    """What a file imports of `benchmarks` and `tests`, which the wheel does not have."""
    names = [
        alias.name if isinstance(node, ast.Import) else node.module or ""
        for node in nodes(file)
        if isinstance(node, (ast.Import, ast.ImportFrom))
        for alias in node.names
    ]
    return [f"{file.name} imports {name}" for name in names if name.split(".")[0] in ("benchmarks", "tests")]


def test_what_the_wheel_holds_imports_nothing_that_it_does_not_hold() -> None:
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    folders = wheel["only-include"]
    assert "lagrotor" in folders and not {"benchmarks", "tests"} & set(folders)
    files = [file for folder in folders for file in sorted((ROOT / folder).rglob("*.py"))]
    assert [line for file in files for line in development_imports(file)] == []


def test_an_import_of_what_the_wheel_does_not_hold_would_be_seen(tmp_path: Path) -> None:
    (tmp_path / "module.py").write_text("def draw():\n    from benchmarks.peers import PEERS\n")
    assert development_imports(tmp_path / "module.py") == ["module.py imports benchmarks.peers"]


def test_no_module_lies_on_a_circle(imports: dict[str, set[str]]) -> None:
    assert circles(imports) == []


def relative(path: Path) -> list[str]:
    """The imports of a file that do not name their module in full."""
    return [
        f"{path.name}: line {node.lineno}" for node in nodes(path) if isinstance(node, ast.ImportFrom) and node.level
    ]


def test_imports_name_their_module_in_full() -> None:
    assert [found for path in MODULES.values() for found in relative(path)] == []


def test_a_relative_import_would_be_seen(tmp_path: Path) -> None:
    (tmp_path / "module.py").write_text("from lagrotor import pair\nfrom .scene import Scene\n")
    assert relative(tmp_path / "module.py") == ["module.py: line 2"]


def test_an_upward_import_and_a_circle_would_be_seen(imports: dict[str, set[str]]) -> None:
    changed = imports | {"lagrotor.errors": {"lagrotor.pair.scene"}}
    assert upward(changed) == ["lagrotor.errors imports lagrotor.pair.scene"]
    assert {"lagrotor.errors", "lagrotor.pair.scene"} in circles(changed)


FACES = {name: names_of_face(path) for name, path in MODULES.items() if path.name == "__init__.py"}


def test_a_face_hands_names_on_and_defines_nothing() -> None:
    for name in FACES:
        blocks = [node for node in ast.parse(MODULES[name].read_text()).body if isinstance(node, ast.If)]
        kinds = (ast.Import, ast.ImportFrom, ast.Assign, ast.AnnAssign, ast.Expr, ast.If)
        assert all(isinstance(node, kinds) for node in ast.parse(MODULES[name].read_text()).body), name
        assert all(isinstance(node, ast.ImportFrom) for block in blocks for node in block.body), name


@pytest.mark.parametrize("name", [name for name, handed in FACES.items() if handed])
def test_every_name_that_a_face_hands_on_is_there(name: str) -> None:
    if name == "lagrotor.proofs":
        pytest.importorskip("flint", reason="python-flint is not installed: the extra `proof`")
    package = import_module(name)
    for public in package.__all__:
        assert getattr(package, public) is getattr(import_module(FACES[name][public]), public)
    with pytest.raises(AttributeError, match="has no attribute 'no_such_name'"):
        package.no_such_name  # noqa: B018


def test_no_name_of_a_face_is_that_of_a_module_beside_it() -> None:
    """Importing the module would put it in the place of the name."""
    beside = {name: {path.stem for path in MODULES[name].parent.iterdir()} for name in FACES}
    assert [(name, both) for name in FACES if (both := beside[name] & FACES[name].keys())] == []


def past_the_face(file: Path) -> list[str]:
    """Names that a file imports from a module, although a face above that module hands them on."""
    return [
        f"{file.name}: {alias.name} from {node.module}"
        for node in nodes(file)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("lagrotor")
        for alias in node.names
        for handed in FACES.values()
        if handed.get(alias.name) == node.module
    ]


@pytest.mark.parametrize("folder", ["derivations", "docs", "figures", "papers", "tests"])
def test_scripts_and_tests_import_through_the_face_of_a_room(folder: str) -> None:
    assert [found for file in sorted((ROOT / folder).rglob("*.py")) for found in past_the_face(file)] == []


def test_an_import_past_the_face_would_be_seen(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text("from lagrotor.paper.proof import prove\n")
    assert past_the_face(tmp_path / "script.py") == ["script.py: prove from lagrotor.paper.proof"]


# Verifies certificates and shares nothing with what makes them: only `check` leaves it.
ALONE = "lagrotor.proofs.checker"


def test_only_its_check_is_taken_from_the_program_that_verifies() -> None:
    taken = {
        alias.name
        for module, path in MODULES.items()
        if not module.startswith(ALONE)
        for node in nodes(path)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(ALONE)
        for alias in node.names
    }
    assert taken == {"check"}


def test_the_program_that_verifies_takes_no_arithmetic_from_the_search() -> None:
    """The table of operations, the equations of what a theorem names, and its words."""
    taken = {
        alias.name
        for module, path in MODULES.items()
        if module.startswith(ALONE)
        for node in nodes(path)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(LEAF)
        for alias in node.names
        if not (node.module or "").startswith(ALONE)
    }
    assert taken == {"OPERATIONS", "Field", "field_of", "structure_program", "theorem_of"}


CLAIMS = "lagrotor/paper/rotor_pair/claims"
PLACES = {
    **dict.fromkeys(("shock", "drift", "toppling", "twist", "natural_rate"), ("lagrotor/theory", CLAIMS)),
    "paired": ("lagrotor/theory",),
    **dict.fromkeys(("standing", "waves"), ("lagrotor/structures",)),
}


def files_named(word: str, folder: Path) -> list[Path]:
    """Python files that have a word in their name or in that of a folder below `folder`."""
    return [path for path in folder.rglob("*.py") if word in path.relative_to(folder).as_posix()]


@pytest.mark.parametrize("word", PLACES)
def test_names_say_where_an_idea_is_derived_computed_judged_drawn_and_tested(word: str) -> None:
    folders = ("derivations", *PLACES[word], "figures", "tests")
    assert [folder for folder in folders if not files_named(word, ROOT / folder)] == []
    assert not files_named(f"no_{word}", ROOT / CLAIMS)  # a name that is nowhere


def test_the_guide_draws_this_house() -> None:
    drawing = (ROOT / "CONTRIBUTING.md").read_text().split("\nlagrotor/\n")[1].split("\nderivations/")[0]
    drawn = [word.rstrip("/") for line in drawing.splitlines() for word in line[:25].split()]
    assert drawn == ROOMS


def public_functions() -> dict[str, ast.FunctionDef]:
    """Each function and method that the reference shows."""
    functions = {}
    faces = [
        file for file in (ROOT / "lagrotor").glob("*/__init__.py") if file.parent.name not in ("drawing", "pictures")
    ]
    for face in (ROOT / "lagrotor/__init__.py", *faces):
        for name, module in names_of_face(face).items():
            tree = ast.parse((ROOT / (module.replace(".", "/") + ".py")).read_text(encoding="utf-8"))
            for node in (node for node in tree.body if getattr(node, "name", "") == name):
                inside = node.body if isinstance(node, ast.ClassDef) else [node]
                functions |= {
                    f"{module}.{name}.{each.name}": each for each in inside if isinstance(each, ast.FunctionDef)
                }
    return {name: each for name, each in functions.items() if not each.name.startswith("_") and ast.get_docstring(each)}


def arguments(function: ast.FunctionDef) -> list[str]:
    """Names of what it takes, without the object or class it belongs to."""
    taken = function.args
    names = [each.arg for each in (*taken.posonlyargs, *taken.args, taken.vararg, *taken.kwonlyargs) if each]
    return [name for name in names if name not in ("self", "cls")]


def explained(docstring: str, section: str) -> set[str]:
    """Names that a section of a numpydoc docstring explains."""
    match = re.search(rf"^{section}\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", docstring, re.MULTILINE | re.DOTALL)
    return set(re.findall(r"^\*{0,2}(\w+)(?= :|$)", match[1], re.MULTILINE)) if match else set()


def test_arguments_and_what_is_raised_have_sections_that_the_reference_sets_as_lists() -> None:
    """One or two arguments are named in the sentence; of three and more each has an entry or is in it by its name."""
    functions = public_functions()
    lacking = {
        name: arguments(each)
        for name, each in functions.items()
        if len(arguments(each)) > 2
        and (
            "Parameters\n-" not in (text := ast.get_docstring(each) or "")
            or [
                a
                for a in arguments(each)
                if a not in explained(text, "Parameters") and not re.search(rf"\b{a}\b", text)
            ]
        )
    }
    assert len(functions) > 300 and lacking == {}
    unknown = {
        name: extra
        for name, each in functions.items()
        if (
            extra := explained(ast.get_docstring(each) or "", "Parameters")
            - {*arguments(each), getattr(each.args.kwarg, "arg", "")}
        )
    }
    assert unknown == {}, "entries of arguments that there are not"
    prose = [name for name, each in functions.items() if re.search(r"\bRaises [A-Za-z]", ast.get_docstring(each) or "")]
    assert prose == []


def test_a_docstring_without_its_sections_is_seen() -> None:
    text = "Do.\n\nParameters\n----------\na : int\n    One.\nc\n    Another.\n\nRaises\n------\nInputError\n    No."
    assert explained(text, "Parameters") == {"a", "c"} and explained(text, "Raises") == {"InputError"}
    assert explained("Do. Parameters: a : one.", "Parameters") == set()
    function = ast.parse("def f(self, a, *b, c=1, **d): ...").body[0]
    assert isinstance(function, ast.FunctionDef) and arguments(function) == ["a", "b", "c"]


def unseen(source: str) -> list[int]:
    """Lines of a script whose proof or remark stands in a loop or a branch: a page shows the values of bare expressions alone."""
    inside = [s for s in ast.parse(source).body if isinstance(s, ast.For | ast.While | ast.If | ast.With | ast.Try)]
    calls = [c for s in inside for c in ast.walk(s) if isinstance(c, ast.Call) and isinstance(c.func, ast.Name)]
    return [call.lineno for call in calls if call.func.id in ("prove", "Remark")]


def test_every_proof_of_a_derivation_is_seen_on_its_page() -> None:
    scripts = [*(ROOT / "derivations").glob("*.py"), *(ROOT / "papers").glob("*/derivations/*.py")]
    assert {f.name: lines for f in scripts if (lines := unseen(f.read_text(encoding="utf-8")))} == {}


def test_a_proof_in_a_loop_would_be_found() -> None:
    assert unseen("for k in (1, 2):\n    prove(k, k)\n") == [2] and unseen("prove(1, 1)\n") == []
