"""The literate scripts of a paper, which run cell by cell; the values of bare expressions in a cell are shown."""

import ast
import re
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from lagrotor.errors import InputError, LagrotorError, LagrotorWarning, ScriptError

_PACKAGE = Path(__file__).resolve().parent.parent
_CELL = re.compile(r"^# %%.*$", re.MULTILINE)
Kind = Literal["derivations", "figures"]


def beside(name: str) -> Path:
    """Return the path of a file or folder that lies beside the package in a checkout, and inside it once installed."""
    for base in (_PACKAGE, _PACKAGE.parent):
        if (base / name).exists():
            return base / name
    raise LagrotorError(f"{name} is neither in nor beside {_PACKAGE}: install lagrotor again")


@dataclass(frozen=True)
class ScriptCell:
    """One cell of a script: prose, or code with the values that it shows and the package's warnings, each once."""

    kind: Literal["prose", "code"]
    text: str
    values: tuple[Any, ...] = ()
    warned: tuple[str, ...] = ()


@dataclass(frozen=True)
class Script:
    """A script that has run: its cells in order, and the names that it defines."""

    cells: tuple[ScriptCell, ...]
    names: dict[str, Any]

    def values_of(self, kind: type) -> list[Any]:
        """Return the values of one type that the cells show, in order; those in tuples and lists count, too."""
        matches = []
        for cell in self.cells:
            for value in cell.values:
                matches += [v for v in (value if isinstance(value, tuple | list) else [value]) if isinstance(v, kind)]
        return matches


@dataclass(frozen=True)
class Scripts:
    """The scripts in `derivations/` and `figures/` under `base`. Each runs once, inside the context that `importable` opens."""

    base: Path
    importable: Callable[[], AbstractContextManager[None]] = nullcontext
    ran: dict[Path, Script] = field(default_factory=dict, repr=False, compare=False)
    remote_names: dict[Path, dict[str, Any]] = field(default_factory=dict, repr=False, compare=False)

    def path(self, kind: Kind, stem: str) -> Path:
        """Return the path of a script, given its folder and its name without `.py`."""
        return self.base / kind / f"{stem}.py"

    def names(self, kind: Kind, prefix: str = "") -> list[str]:
        """Return the names of the scripts in a folder that begin with `prefix`, with t2 before t10."""
        stems = (path.stem for path in (self.base / kind).glob(f"{prefix}*.py") if not path.stem.startswith("_"))
        return sorted(stems, key=by_numbers)

    def executed(self, kind: Kind, stem: str) -> Script:
        """Return a script after its run; it runs at the first call only. Raise ScriptError with file and line if it fails."""
        path = self.path(kind, stem)
        if path not in self.ran:
            with self._within(path):
                self.ran[path] = run_file(path)
        return self.ran[path]

    def run(self, kind: Kind, stem: str) -> dict[str, Any]:
        """Return the names that a script defines, with their values; it runs if it has not run yet."""
        path = self.path(kind, stem)
        return self.remote_names[path] if path in self.remote_names else self.executed(kind, stem).names

    @contextmanager
    def remote_values(self, values: Mapping[str, Mapping[str, Any]]) -> Iterator[None]:
        """Let `run` return the given values (script → name → value) within the block. If a name is missing, its script runs."""
        self.remote_names.update(
            {self.path("derivations", stem): _RemoteNames(self, stem, v) for stem, v in values.items()}
        )
        try:
            yield
        finally:
            self.remote_names.clear()

    def called(self, kind: Kind, stem: str, name: str) -> Any:
        """Return the result of a function that a script defines; raise ScriptError with file and line if it fails."""
        function = self.run(kind, stem)[name]
        with self._within(self.path(kind, stem)):
            return function()

    @contextmanager
    def _within(self, path: Path) -> Iterator[None]:
        with self.importable():
            try:
                yield
            except Exception as error:
                raise ScriptError(_failure(path, error)) from error

    @cached_property
    def stating(self) -> dict[str, tuple[str, int]]:
        """For each equation id, the derivation and the line of its verdict, found without running the scripts."""
        places: dict[str, tuple[str, int]] = {}
        for stem in self.names("derivations"):
            for identifier, line in verdicts_in(self.path("derivations", stem)):
                if identifier in places:
                    first = "{}.py:{}".format(*places[identifier])
                    raise InputError(
                        f"{stem}.py:{line}: a verdict on {identifier} is in {first} already: keep one of them"
                    )
                places[identifier] = stem, line
        return places


def by_numbers(name: str) -> list[tuple[int, str]]:
    """Return a sort key of a name that puts t2 before t10 and 3.2 before 3.10."""
    return [(int(number or 0), text) for number, text in re.findall(r"(\d*)(\D*)", name)]


class _RemoteNames(dict[str, Any]):
    """The names that a derivation defined in another process. If a name is missing, the script runs in this process.

    The warnings of its simulations stand on its own page, not on that of the script that imports the name.
    """

    def __init__(self, scripts: Scripts, stem: str, values: Mapping[str, Any]) -> None:
        super().__init__(values)
        self.scripts, self.stem = scripts, stem

    def __missing__(self, name: str) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LagrotorWarning)
            return self.scripts.executed("derivations", self.stem).names[name]


def verdicts_in(path: Path) -> list[tuple[str, int]]:
    """Return the equation id and the line of each call of `verdict` in a derivation; raise ScriptError for invalid Python."""
    calls = []
    tree = _tree(path) if "verdict(" in path.read_text(encoding="utf-8") else ast.Module([], [])
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "verdict" and node.args:
            first = node.args[0]
            if isinstance(first, ast.Constant) and isinstance(first.value, str):
                calls.append((first.value, node.lineno))
    return calls


def _tree(path: Path) -> ast.Module:
    try:
        return ast.parse(path.read_text(encoding="utf-8"), str(path))
    except SyntaxError as error:
        raise ScriptError(f"{path}:{error.lineno}: {error.msg}") from None


def _failure(path: Path, error: Exception) -> str:
    """Return the text `file:line: error` of an error, with the last line of the script itself in the traceback."""
    if isinstance(error, SyntaxError):
        return f"{path}:{error.lineno}: {error.msg}"
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    kind = "" if isinstance(error, LagrotorError) else f"{type(error).__name__}: "
    return f"{path}:{lines[-1] if lines else 1}: {kind}{error}"


def run_file(path: Path) -> Script:
    """Run a script in the percent format, in which `# %%` begins a cell of code and `# %% [markdown]` one of prose."""
    source = path.read_text(encoding="utf-8")
    defined: dict[str, Any] = {"__name__": path.stem, "__file__": str(path)}
    starts = [match.start() for match in _CELL.finditer(source)] or [0]
    statements = ast.parse(source).body
    cells = []
    for start, end in zip(starts, [*starts[1:], len(source)], strict=True):
        text = source[start:end]
        head, _, body = text.partition("\n") if text.startswith("# %%") else ("", "", text)
        if "[markdown]" in head:
            cells.append(ScriptCell("prose", re.sub(r"^# ?", "", body, flags=re.MULTILINE).strip()))
        else:
            first, last = (1 + source.count("\n", 0, place) for place in (start, end))
            in_cell = (statement for statement in statements if first <= statement.lineno <= last)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", LagrotorWarning)
                values = tuple(value for statement in in_cell for value in _execute(statement, path, defined))
            for warning in caught:
                warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
            warned = dict.fromkeys(
                str(warning.message) for warning in caught if issubclass(warning.category, LagrotorWarning)
            )
            cells.append(ScriptCell("code", body.strip(), values, tuple(warned)))
    return Script(tuple(cells), defined)


def _execute(statement: ast.stmt, path: Path, defined: dict[str, Any]) -> list[Any]:
    """Execute a statement. Return its value in a list if it is an expression with a value, else an empty list."""
    if not isinstance(statement, ast.Expr):
        exec(compile(ast.Module([statement], []), str(path), "exec"), defined)
        return []
    value = eval(compile(ast.Expression(statement.value), str(path), "eval"), defined)
    return [] if value is None or isinstance(statement.value, ast.Constant) else [value]


@contextmanager
def importable(folder: Path, modules: dict[str, ModuleType]) -> Iterator[None]:
    """Let `import name` find `folder/name.py` within the block. `modules` keeps the imported modules for the next block."""
    imported = dict(sys.modules)
    sys.modules.update(modules)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in (sys.modules.keys() - imported.keys()) | (sys.modules.keys() & modules.keys()):
            module = sys.modules[name]
            if module is not imported.get(name) and _lies_in(folder, module):
                modules[name] = module
                if name in imported:
                    sys.modules[name] = imported[name]
                else:
                    del sys.modules[name]


def _lies_in(folder: Path, module: ModuleType) -> bool:
    file = getattr(module, "__file__", None)
    return file is not None and Path(file).parent == folder and "." not in module.__name__
