"""The table of public names of earlier releases. Each still works, with a DeprecationWarning that names the new one."""

import sys
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, ParamSpec, TypeVar
from warnings import warn

# Old module → new module. A row of a package also covers the modules in it.
RENAMED = {
    "lagrotor.proved": "lagrotor.proofs",
    "lagrotor.proved.carried_sets": "lagrotor.proofs.lohner_frames",
    "lagrotor.proved.checking": "lagrotor.proofs.checker.checking",
    "lagrotor.proved.closed_orbits": "lagrotor.proofs.orbits.closed_orbits",
    "lagrotor.proved.crossings": "lagrotor.proofs.orbits.crossings",
    "lagrotor.proved.enclosure": "lagrotor.proofs.orbits.enclosure",
    "lagrotor.proved.paired_orbits": "lagrotor.proofs.orbits.paired_orbits",
    "lagrotor.proved.steady": "lagrotor.proofs.orbits.equilibria",
    "lagrotor.proved.stepping": "lagrotor.proofs.taylor_step",
    "lagrotor.proved.tails": "lagrotor.proofs.truncated_series",
}

# Old name of a package → where it is defined now.
NAMES = {
    "lagrotor.mechanics.bias": "lagrotor.mechanics.lagrangian.bias",
    "lagrotor.pair.JOINT_LINE": "lagrotor.pair.lagrangians.JOINT_LINE",
    "lagrotor.pair.UNITS": "lagrotor.pair.trajectory.UNITS",
    "lagrotor.pair.ansatz_lagrangian": "lagrotor.pair.lagrangians.ansatz_lagrangian",
    "lagrotor.pair.scene_of": "lagrotor.pair.scene_document.scene_of",
    "lagrotor.pair.scene_toml": "lagrotor.pair.scene_document.scene_toml",
    "lagrotor.algebra.check_names": "lagrotor.algebra.name_clashes.check_names",
    "lagrotor.mechanics.FourierSeries": "lagrotor.mechanics.fourier.FourierSeries",
    "lagrotor.mechanics.characteristic_exponents": "lagrotor.mechanics.weakly_nonlinear.characteristic_exponents",
    "lagrotor.mechanics.lindstedt_poincare": "lagrotor.mechanics.weakly_nonlinear.periodic_series",
    "lagrotor.theory.most_growth": "lagrotor.theory.paired_precession.stability.growth_bound",
    "lagrotor.mechanics.map_normal_form": "lagrotor.mechanics.canonical.return_maps.map_normal_form",
    "lagrotor.mechanics.project_position": "lagrotor.mechanics.constraints.project_position",
    "lagrotor.mechanics.project_velocity": "lagrotor.mechanics.constraints.project_velocity",
    "lagrotor.mechanics.solve_constrained": "lagrotor.mechanics.constraints.solve_constrained",
    "lagrotor.paper.Relation": "lagrotor.paper.verdicts.Relation",
    "lagrotor.paper.Statement": "lagrotor.paper.verdicts.Statement",
    "lagrotor.paper.chain": "lagrotor.paper.verdicts.chain",
    "lagrotor.paper.decide": "lagrotor.paper.ledger.decide",
    "lagrotor.numerics.Program": "lagrotor.numerics.codegen.Program",
    "lagrotor.numerics.best_harmonics": "lagrotor.numerics.curves.best_harmonics",
    "lagrotor.numerics.compile_program": "lagrotor.numerics.printers.compile_program",
    "lagrotor.numerics.harmonics_at": "lagrotor.numerics.curves.harmonics_at",
    "lagrotor.numerics.mean_between": "lagrotor.numerics.curves.mean_between",
    "lagrotor.numerics.skew_matrix": "lagrotor.numerics.rotations.skew_matrix",
    "lagrotor.models.closed_form": "lagrotor.models.closed_form_model.closed_form",
    "lagrotor.structures.chern_numbers": "lagrotor.structures.waves.chern.chern_numbers",
    "lagrotor.structures.dispersion": "lagrotor.structures.waves.dispersion.dispersion",
    "lagrotor.structures.edge_waves": "lagrotor.structures.waves.chern.edge_waves",
    "lagrotor.structures.long_wave_speeds": "lagrotor.structures.waves.dispersion.long_wave_speeds",
}

# Class → {old attribute: new attribute}. The class takes `old_attribute` as its `__getattr__`.
ATTRIBUTES = {
    "AveragedMotion": {"letters": "amplitudes"},
    "Chern": {"off": "flux_error"},
    "Decision": {"at": "points", "seen": "residual"},
    "Equations": {"mass": "mass_matrix", "push": "generalised_forces"},
    "PrecessionLaw": {"beside": "quadratic"},
    "Stated": {"written": "form"},
    "Step": {"written": "equations"},
}

# Function or method, by its qualified name → {old keyword: new keyword}.
KEYWORDS: dict[str, dict[str, str]] = {
    "System.from_sympy": {"given": "source"},
    "judge": {"given": "premises"},
    "judge_text": {"given": "premises"},
    "parameter_premise": {"put": "substitution", "own": "scene_values"},
    "prove": {"left": "lhs", "right": "rhs", "written": "equations"},
    "verdict": {"written": "form"},
    "Paper.changes": {"found": "results"},
    "Paper.evaluate": {"wanted": "ids"},
    "Paper.renew_record": {"found": "results"},
    "MovingFrame.place": {"seen": "frame"},
    "MovingFrame.velocity": {"seen": "frame"},
    "Pathway.spring": {"rest": "rest_length"},
    "bare": {"seen": "points"},
    "canvas": {"seen": "points"},
    "crossing": {"before": "t_end"},
    "distance_over_one_turn": {"most": "greatest"},
    "no_crossing": {"until": "t_end"},
    "periodic_orbit": {"held": "fixed"},
    "periodic_series": {"rest": "equilibrium", "begins_at": "mode_power"},
    "decide_equal": {"left": "lhs", "right": "rhs", "within": "assumptions"},
    "decide_zero": {"within": "assumptions"},
}

P = ParamSpec("P")
R = TypeVar("R")


def accept_old_keywords(function: Callable[P, R]) -> Callable[P, R]:
    """Let a function accept its keywords of earlier releases, which KEYWORDS lists under its qualified name."""
    row = KEYWORDS[function.__qualname__]

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        for old, new in row.items():
            if old in kwargs:
                if new in kwargs:
                    raise TypeError(f"{function.__qualname__}: {old} is the old name of {new}: give {new} alone")
                warn(f"{function.__qualname__}: {old} is now {new}", DeprecationWarning, stacklevel=2)
                kwargs[new] = kwargs.pop(old)
        return function(*args, **kwargs)

    return call


def old_name(package: str, name: str) -> Any:
    """Return the object that a package had under an old name; None if `name` is no old name in this package."""
    if (new := NAMES.get(f"{package}.{name}")) is None:
        return None
    module, attribute = new.rsplit(".", 1)
    value = getattr(import_module(module), attribute)
    # After the import, which may reset the registry of warnings that were shown: `from package import name` asks twice.
    warn(f"{package}.{name} is now {new}: import that instead", DeprecationWarning, stacklevel=3)
    return value


def old_attribute(instance: Any, name: str) -> Any:
    """Return the attribute that an object had under an old name; raise AttributeError if `name` is no old name."""
    for kind in type(instance).__mro__:
        if new := ATTRIBUTES.get(kind.__name__, {}).get(name):
            warn(f"{kind.__name__}.{name} is now {new}: use that instead", DeprecationWarning, stacklevel=2)
            return getattr(instance, new)
    return object.__getattribute__(instance, name)


def new_name(name: str) -> str | None:
    """Return the new name of a module that RENAMED lists, itself or a package above it; None if neither is listed."""
    rows = [old for old in RENAMED if name == old or name.startswith(f"{old}.")]
    return RENAMED[old] + name.removeprefix(old) if (old := max(rows, key=len, default="")) else None


class RenamedModules(MetaPathFinder, Loader):
    """A finder of modules by their old names. It returns the module itself, never a second copy of it."""

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Warn, and return the specification of a renamed module; None for any other name."""
        if (new := new_name(name)) is None:
            return None
        warn(f"{name} is now {new}: import that instead", DeprecationWarning, stacklevel=2)
        return ModuleSpec(name, self)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import the module of the new name."""
        module = import_module(str(new_name(spec.name)))
        spec.loader_state = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Restore the module's specification, which the import has replaced by one with the old name."""
        module.__spec__ = module.__spec__ and module.__spec__.loader_state


def install() -> None:
    """Put the finder of renamed modules before Python's finders, unless it is already there."""
    if not any(isinstance(finder, RenamedModules) for finder in sys.meta_path):
        sys.meta_path.insert(0, RenamedModules())
