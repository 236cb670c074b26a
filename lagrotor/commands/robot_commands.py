"""The commands for a robot file: equations, and simulate for a file in place of a scene."""

import argparse
import math
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lagrotor.commands.terminal import Command, check_folder, print_json, progress, table
from lagrotor.errors import InputError, near
from lagrotor.files import FILMS, write_text

if TYPE_CHECKING:
    from lagrotor.mechanics.systems import RobotSystem

_FORMATS = {".md": "markdown", ".tex": "latex", ".html": "html"}
_MOST_COORDINATES = 6
_MOST_OPERATIONS = 1000  # in the Lagrangian
_MOST_PRINTED = 3000  # operations in one printed formula
_FPS = 25.0  # frames per second

Section = tuple[str, list[str], list[str]]  # heading, formulas in LaTeX, lines of text


def add_robot(parser: argparse.ArgumentParser) -> None:
    says = "the root link of a URDF file is fixed to the ground (default) or floating"
    parser.add_argument("--base", choices=("fixed", "floating"), default="fixed", help=says)


def add_robot_commands(command: Command) -> None:
    """Add the commands equations and export."""
    added = command(
        "equations",
        equations_command,
        "derive the equations of motion of a robot from its URDF or MJCF file",
        "lagrotor equations arm.urdf --out arm.html",
    )
    _add_file(added)
    says = "of the text (default: by the name of --out, else markdown)"
    added.add_argument("--format", choices=tuple(_FORMATS.values()), help=says)
    added.add_argument("--out", type=Path, metavar="FILE", help="write a .md, .tex or .html instead of printing")
    added = command(
        "export",
        export_command,
        "write the equations of motion of a robot as functions of C, CasADi, JAX, Julia or MATLAB",
        "lagrotor export arm.urdf --to c --out folder",
    )
    _add_file(added)
    says = "the language; Octave reads the files of matlab"
    added.add_argument("--to", required=True, choices=("c", "casadi", "jax", "julia", "matlab"), help=says)
    says = "the folder, which is made if it is missing"
    added.add_argument("--out", type=Path, required=True, metavar="FOLDER", help=says)
    added.add_argument("--name", help="the first part of the names of files and functions (default: that of the file)")


def _add_file(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, metavar="FILE", help="a URDF or MJCF file")
    add_robot(parser)
    says = "inertia: masses, centres and inertias are symbols (default); all: lengths, too; none: numbers"
    parser.add_argument("--symbols", choices=("inertia", "all", "none"), default="inertia", help=says)


def export_command(options: argparse.Namespace) -> int:
    system = read_robot(options.file, options.symbols, options.base)
    name = options.file.stem if options.name is None else options.name
    print("\n".join(map(str, system.export(options.to, options.out, name))))
    for each in system.not_read:
        print(f"not read: {each}", file=sys.stderr)
    return 0


def read_robot(path: Path, symbols: Any, base: str) -> "RobotSystem":
    """Return the system of a URDF or MJCF file, whichever its root element says."""
    from lagrotor.mechanics import System
    from lagrotor.mechanics.robot_files.xml_elements import read_xml

    if (root := read_xml(path)).tag != "mujoco":
        return System.from_urdf(path, symbols, base)
    if base != "fixed":
        raise root.refusal("an MJCF file says itself which bodies are free: leave out --base")
    return System.from_mjcf(path, symbols)


def equations_command(options: argparse.Namespace) -> int:
    form = options.format or "markdown"
    if options.out:
        if options.out.suffix not in _FORMATS:
            raise InputError(f"--out {options.out}: the name must end in {', '.join(_FORMATS)}")
        form = options.format or _FORMATS[options.out.suffix]
        check_folder(options.out.parent)
    system = read_robot(options.file, options.symbols, options.base)
    text = _WRITERS[form](options.file.name, _sections(system))
    if options.out:
        print(write_text(options.out, text))
    else:
        print(text, end="")
    return 0


def _sections(system: "RobotSystem") -> list[Section]:
    """Return the sections of the text: coordinates, formulas, values, what was not read, and notes."""
    from lagrotor.mechanics.expressions import longer
    from lagrotor.mechanics.glossary import formulas, in_decimals, latex

    names = (f"{joint}: {', '.join(map(str, own))}" for joint, own in system.joint_coordinates.items())
    sections: list[Section] = [("Joints and their coordinates", [], list(names))]
    n = len(system.c.q)
    if n > _MOST_COORDINATES or longer(system.L, _MOST_OPERATIONS):
        reason = (
            f"The kinetic energy of {n} coordinates is not written out: the text has at most {_MOST_COORDINATES} coordinates and "
            f"{_MOST_OPERATIONS:,} operations in the Lagrangian. The equations of motion exist all the same, as a recursion: "
            "System.rhs computes them in numbers, and lagrotor simulate runs them."
        )
        sections.append(("Equations of motion", [], [reason]))
        L = system.lagrangian
        fields = tuple(term for term in L.terms if term[1] is not None)
        V = -replace(L, terms=fields, remainder=L.remainder.subs(dict.fromkeys(system.c.v, 0))).expression
        if V != 0 and not longer(V, _MOST_OPERATIONS):
            sections.append(("Potential energy", [f"V = {latex(in_decimals(V))}"], []))
    else:
        sections += [(heading, lines, []) for heading, lines in formulas(system, _MOST_PRINTED).items()]
    words = {word for s in (*system.c.q, *system.values) for word in re.findall("[A-Za-z]{3,}", str(s))}
    name = re.compile(rf"(?<![\\A-Za-z])({'|'.join(words) or '$.'})(?![A-Za-z])")
    space = re.compile(r"(?<=[}\w]) (?=\\d+ot\{\\mathrm)")  # between words of a product
    sections = [
        (h, [space.sub(r" \\, ", name.sub(r"\\mathrm{\1}", e)) for e in lines], text) for h, lines, text in sections
    ]
    values = [f"{symbol} = {value:.10g}" for symbol, value in system.values.items()]
    sections += [("Values of the file", [], values), ("Not read", [], list(system.not_read))]
    sections.append(("Notes", [], list(system.notes)))
    return [section for section in sections if section[1] or section[2]]


def _markdown(name: str, sections: list[Section]) -> str:
    text = f"# {name}\n"
    for heading, formulas, lines in sections:
        text += f"\n## {heading}\n\n" + "".join(f"$$\n{formula}\n$$\n\n" for formula in formulas)
        text += "".join(f"- {line}\n" for line in lines)
    return text


def _latex(name: str, sections: list[Section]) -> str:
    def plain(text: str) -> str:
        return "".join(f"\\{c}" if c in "_%&#${}" else c for c in text)

    text = "\\documentclass{article}\n\\usepackage{amsmath}\n\\begin{document}\n"
    text += f"\\section*{{{plain(name)}}}\n"
    for heading, formulas, lines in sections:
        text += f"\\subsection*{{{heading}}}\n" + "".join(f"\\[\n{formula}\n\\]\n" for formula in formulas)
        items = "".join(f"\\item {plain(line)}\n" for line in lines)
        text += f"\\begin{{itemize}}\n{items}\\end{{itemize}}\n" if lines else ""
    return text + "\\end{document}\n"


_STYLE = (
    "body{font-family:serif;max-width:60em;margin:2em auto}div{overflow-x:auto;margin:.6em 0}code{white-space:pre-wrap}"
)


def _html(name: str, sections: list[Section]) -> str:
    from lagrotor.report.formulas.mathml_latex import mathml

    text = f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(name)}</title>'
    text += f"<style>{_STYLE}</style></head><body>\n<h1>{escape(name)}</h1>\n"
    for heading, formulas, lines in sections:
        text += f"<h2>{escape(heading)}</h2>\n"
        text += "".join(f"<div>{mathml(e) or f'<code>{escape(e)}</code>'}</div>\n" for e in formulas)
        text += f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>\n" if lines else ""
    return text + "</body></html>\n"


_WRITERS = {"markdown": _markdown, "latex": _latex, "html": _html}


def simulate_robot(options: argparse.Namespace) -> int:
    """Simulate the robot of a file and print the last state, or write the run to --out."""
    import numpy as np

    from lagrotor.mechanics.robot_files.description import skeleton

    system = read_robot(options.file, "none", options.base)
    q0, v0 = _start(system, options.start or ())
    if system.constraints:
        near_q, near_v = system.consistent({}, q0, v0)
        q0 = dict(zip(map(str, system.c.q), near_q, strict=True))
        v0 = dict(zip(map(str, system.speeds), near_v, strict=True))
    with progress(math.ceil(options.t_end)) as step:
        times, done = np.linspace(0.0, options.t_end, options.samples), [0]

        def show(now: float) -> None:
            if now >= done[0] + 1:
                done[0] = int(now)
                step(f"{now:.0f} s of motion", done[0])

        run = system.simulate({}, q0, v0, times, tol=options.tol, progress=show)
    if options.out and options.out.suffix in FILMS:
        run.animate(options.out, _FPS, skeleton(system))
    elif options.out:
        run.save(options.out)
    summary = {
        "file": str(options.file), "samples": len(run.t), "t_end": float(run.t[-1]), "error": run.error,
        "evaluations": run.evaluations, "energy_first": float(run.energy[0]), "energy_last": float(run.energy[-1]),
        "end": {str(s): float(x) for s, x in zip((*system.c.q, *system.speeds), (*run.q[-1], *run.u[-1]), strict=True)},
        "not_read": list(system.not_read),
    }  # fmt: skip
    if options.json:
        print_json(summary)
    elif options.out:
        print(f"{options.out}: {len(run.t)} times, estimated error {run.error:.2g}")
    else:
        print(_table(summary))
    return 0


def _start(system: "RobotSystem", given: Sequence[str]) -> tuple[dict[str, float], dict[str, float]]:
    """Return the initial coordinates and velocities: those of the file and zeros, with the changes NAME=NUMBER."""
    q0, v0 = dict(system.start), dict.fromkeys(map(str, system.speeds), 0.0)
    for text in given:
        name, _, number = text.partition("=")
        if name not in q0 | v0:
            meant = near(name, q0 | v0) or f": choose of {', '.join(q0 | v0)}"
            raise InputError(f"--start {text}: {name!r} is no coordinate and no velocity of the file{meant}")
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f"--start {text}: write NAME=NUMBER, in rad, m, rad/s or m/s")
        (q0 if name in q0 else v0)[name] = value
    return q0, v0


def _table(summary: dict[str, Any]) -> str:
    rows = [
        ("estimated error", f"{summary['error']:.2g}"),
        ("evaluations", str(summary["evaluations"])),
        ("initial energy [J]", f"{summary['energy_first']:.12g}"),
        ("final energy [J]", f"{summary['energy_last']:.12g}"),
        *((f"{name} at the end", f"{value:.9f}") for name, value in summary["end"].items()),
        ("not read", "; ".join(summary["not_read"]) or "nothing"),
    ]
    return table((f"{summary['t_end']:g} s", f"{summary['samples']} times"), rows)
