"""What the commands take: a parser that refuses in one line, the scene's options, where output may go."""

import argparse
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from lagrotor.errors import InputError, near
from lagrotor.files import FILMS, PICTURES
from lagrotor.pair.scene import Link, Rotor, Scene, Shock

# Adds a command: its name, what runs it, what it does, an example.
Command = Callable[[str, Callable[[argparse.Namespace], int], str, str], argparse.ArgumentParser]


class Parser(argparse.ArgumentParser):
    """argparse, but a refusal is an InputError, and -1e-3 and -inf are numbers, not options."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False, **settings)
        self._negative_number_matcher = re.compile(r"-(\d|\.\d|inf|nan)", re.IGNORECASE)

    def error(self, message: str) -> NoReturn:
        choice = re.search(r"invalid choice: (.*) \(choose from (.*)\)", message)
        hint = near(choice[1].strip("'"), re.findall(r"[\w-]+", choice[2])) if choice else ""
        raise InputError(f"{message}{hint}; see {self.prog} --help")


def _numbers(group: Any, name: str, letters: tuple[str, ...], says: str, **more: Any) -> None:
    group.add_argument(name, nargs=len(letters), type=float, metavar=letters, help=says, **more)


def add_pair(parser: argparse.ArgumentParser) -> None:
    """The options of spins, rotors and bar."""
    group = parser.add_argument_group("rotors and bar")
    _numbers(group, "--spins", ("W1", "W2"), "axial angular velocities, rad/s")
    group.add_argument("--scene", type=Path, metavar="FILE", help="the whole scene from a TOML file instead")
    for name, usual, says in (
        ("--rotor-mass", Rotor.mass, "mass of a rotor, kg"),
        ("--rotor-length", Rotor.length, "length of a rotor's axis, m"),
        ("--I1", Rotor.I1, "transverse inertia about the centre, kg m²"),
        ("--I3", Rotor.I3, "axial inertia, kg m²"),
        ("--link-length", Link.length, "length of the bar, m"),
        ("--link-mass", Link.mass, "mass of the bar, kg"),
        ("--link-inertia", Link.inertia, "transverse inertia of the bar, kg m²"),
    ):
        group.add_argument(name, type=float, metavar="X", help=f"{says} (default: {usual:g})")
    group.add_argument("--no-link", action="store_true", help="a pair without a bar")


def add_start(parser: argparse.ArgumentParser) -> None:
    """The options of where the pair starts."""
    group = parser.add_argument_group("start")
    _numbers(group, "--axes", ("X1", "Y1", "Z1", "X2", "Y2", "Z2"), "unit vectors at t = 0 (default: upright)")
    _numbers(group, "--rates", ("X1", "Y1", "Z1", "X2", "Y2", "Z2"), "their rates at t = 0, 1/s (default: at rest)")


def add_shock(parser: argparse.ArgumentParser) -> None:
    """The shock's options."""
    group = parser.add_argument_group("shock: force exp(-((t - time)/width)^2) on the tip of one rotor")
    _numbers(group, "--shock", ("FX", "FY", "FZ"), "force, N; needs --shock-time and --shock-width")
    group.add_argument("--shock-time", type=float, metavar="S", help="centre of the pulse, s")
    group.add_argument("--shock-width", type=float, metavar="S", help="width of the pulse, s")
    group.add_argument("--shock-body", type=int, metavar="N", help="rotor 1 (left) or 2 (default: 1)")


def scene_from_options(given: argparse.Namespace, shock: Shock | None = None) -> Scene:
    """The scene that the options describe, or that of the file. Raises InputError for one that makes no sense."""
    if given.scene:
        return _scene_of_file(given, shock)
    if given.spins is None:
        raise InputError("--spins W1 W2 is missing: give the axial angular velocities in rad/s, or --scene FILE")
    start = {
        name: (tuple(values[:3]), tuple(values[3:]))
        for name in ("axes", "rates")
        if (values := vars(given).get(name)) is not None  # rate takes no start
    }
    return Scene(
        spins=tuple(given.spins),
        rotor=Rotor(**_fields(given, ROTOR_OPTIONS)),
        link=_link(given),
        shock=shock,
        **start,
    )


# Field → the option's name in what was parsed.
ROTOR_OPTIONS = {"mass": "rotor_mass", "length": "rotor_length", "I1": "I1", "I3": "I3"}
LINK_OPTIONS = {"length": "link_length", "mass": "link_mass", "inertia": "link_inertia"}


def _fields(given: argparse.Namespace, options: dict[str, str]) -> dict[str, float]:
    """The fields whose options were given."""
    return {name: value for name, option in options.items() if (value := getattr(given, option)) is not None}


def _scene_of_file(given: argparse.Namespace, shock: Shock | None) -> Scene:
    """The scene of --scene FILE. Raises InputError where other options describe one too."""
    from lagrotor.pair.scene_document import read_scene

    named = {"--spins": given.spins, "--shock": shock, "--no-link": given.no_link or None}
    named |= {
        f"--{option.replace('_', '-')}": getattr(given, option)
        for option in (*ROTOR_OPTIONS.values(), *LINK_OPTIONS.values())
    }
    named |= {f"--{name}": vars(given).get(name) for name in ("axes", "rates")}
    if both := [name for name, value in named.items() if value is not None]:
        raise InputError(f"--scene and {both[0]}: the file has the whole scene; change it there")
    return read_scene(given.scene)


def _link(given: argparse.Namespace) -> Link | None:
    """The bar, if any. Raises InputError for one that is described and left out."""
    bar = _fields(given, LINK_OPTIONS)
    if given.no_link and bar:
        raise InputError(f"--no-link and --link-{next(iter(bar))}: a pair without a bar has none; leave one out")
    return None if given.no_link else Link(**bar)


def shock_from_options(given: argparse.Namespace) -> Shock | None:
    """The shock that the options describe, if any. Raises InputError when a part of it is missing."""
    parts = {"--shock-time": given.shock_time, "--shock-width": given.shock_width}
    if given.shock is None:
        if lonely := [
            name for name, value in (parts | {"--shock-body": given.shock_body}).items() if value is not None
        ]:
            raise InputError(f"{lonely[0]} without --shock: give the force too")
        return None
    if missing := [name for name, value in parts.items() if value is None]:
        raise InputError(f"--shock needs {' and '.join(missing)}")
    body = 1 if given.shock_body is None else given.shock_body
    return Shock(tuple(given.shock), given.shock_time, given.shock_width, body)


def check_file(path: Path) -> None:
    """Raises InputError unless a run can be written there."""
    endings = (".npz", ".csv", *PICTURES, *FILMS)
    if path.suffix not in endings:
        raise InputError(f"--out {path}: the name must end in {', '.join(endings)}")
    if path.is_dir():
        raise InputError(f"--out {path} is a folder: give a file")
    check_folder(path.parent)


def check_folder(folder: Path) -> None:
    """Raises InputError unless files can be written into the folder."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--out: {folder} is a file: give a folder")
    if not folder.is_dir():
        raise InputError(f"--out: there is no folder {folder}: make it first")
    if not os.access(folder, os.W_OK):
        raise InputError(f"--out: the folder {folder} cannot be written to: choose another")
