"""The command that is given a structure: whether it stands, its modes, a picture or a film of it."""

import argparse
import json
import math
from functools import partial
from pathlib import Path
from typing import Any

from lagrotor.commands.options import Command, check_folder
from lagrotor.errors import InputError
from lagrotor.files import FILMS, PICTURES

_ENDINGS = (*PICTURES, *FILMS, ".toml")
_json = partial(json.dumps, indent=1, ensure_ascii=False)


def add_structure_commands(command: Command) -> None:
    """structure."""
    added = command(
        "structure",
        structure_command,
        "whether a structure of rotors and bars stands, and its modes",
        "lagrotor structure corner --out corner.png",
    )
    says = "a TOML file with joints, bars, spins …, or a name of the gallery, such as corner; list names them"
    added.add_argument("structure", metavar="FILE", help=says)
    added.add_argument(
        "--out", type=Path, metavar="FILE", help="write a picture, a film (.gif, .mp4) or the .toml itself"
    )
    added.add_argument("--t-end", type=float, metavar="S", help="length of the film, s (default: the gallery's, or 5)")
    added.add_argument("--json", action="store_true", help="print a JSON object")


def structure_command(given: argparse.Namespace) -> int:
    from lagrotor.commands.terminal import table
    from lagrotor.structures.gallery import GALLERY, example
    from lagrotor.structures.structure import read_structure

    if given.structure == "list":
        listed = {name: each.says for name, each in GALLERY.items()}
        print(_json(listed) if given.json else table(("name", "what it shows"), list(listed.items())))
        return 0
    if given.out and given.out.suffix not in _ENDINGS:
        raise InputError(f"--out {given.out}: the name must end in {', '.join(_ENDINGS)}")
    if given.out:
        check_folder(given.out.parent)
    s = read_structure(given.structure) if given.structure.endswith(".toml") else example(given.structure)
    if given.out:
        ready = GALLERY.get(given.structure)
        usual = ready.duration if ready else 5.0
        _write(s, given.out, usual if given.t_end is None else given.t_end)
    summary = _summary(s)
    print(_json(summary) if given.json else _table(summary))
    if given.out and not given.json:
        print(given.out)
    return 0


def _write(s: Any, out: Path, duration: float) -> None:
    import numpy as np

    from lagrotor.files import write_beside
    from lagrotor.structures.structure import write_structure

    if out.suffix == ".toml":
        write_structure(s, out)
    elif out.suffix in PICTURES:
        write_beside(out, lambda file: s.plot().savefig(file, format=out.suffix[1:]))
    else:
        from lagrotor.drawing.film import check_film

        check_film(out, duration, 25.0)
        tilt = 0.05 * np.random.default_rng(1).standard_normal((len(s.joints), 2))
        s.simulate(np.linspace(0, duration, math.ceil(100 * duration) + 1), tilt, tol=1e-6).animate(out)


def _summary(s: Any) -> dict[str, Any]:
    rotors, bars = len(s.joints), len(s.bars)
    summary: dict[str, Any] = {"rotors": rotors, "bars": bars, "degrees_of_freedom": 2 * rotors - bars}
    if not s.natural:
        why = "upright, a bar is not as long as its tips are apart; a film shows how it moves (--out FILE.gif)"
        return summary | {"stands": None, "why": why}
    standing, modes = s.stands(), s.modes()
    return summary | {
        "stands": standing.stands,
        "kind": standing.kind,
        "why": standing.why,
        "growth": standing.growth,
        "critical_spin": standing.critical_spin if standing.critical_spin < math.inf else None,
        "topple": modes.topple,
        "modes": [
            {"rate": float(w), "growth": float(g), "energy_sign": int(sign)}
            for w, g, sign in zip(modes.rates, modes.growth, modes.energy_signs, strict=True)
        ],
    }


def _table(summary: dict[str, Any]) -> str:
    from lagrotor.commands.terminal import table

    verdict = {True: "yes", False: "no", None: "not judged"}[summary["stands"]]
    rows = [("stands", f"{verdict}: {summary['why']}")]
    count = f"{summary['degrees_of_freedom']}; rotors: {summary['rotors']}, bars: {summary['bars']}"
    if summary["stands"] is None:
        return table(("structure", ""), [*rows, ("degrees of freedom", count)])
    factor = summary["critical_spin"]
    least = "none holds it" if factor is None else f"{factor:.6g} times its spins" if factor else "none is needed"
    modes = enumerate(summary["modes"], 1)
    kind = "never at these spins" if summary["kind"] == "never" and factor else summary["kind"]
    rows.insert(0, ("standing", kind))
    rows += [
        ("least spin, to first order", least),
        ("degrees of freedom", f"{count}; modes that grow: {summary['topple']}"),
    ]
    energies = {1: "", 0: "", -1: ", of negative energy"}
    rows += [
        (f"mode {k}", f"{m['rate']:.6g} rad/s, growth {m['growth']:.4g} 1/s{energies[m['energy_sign']]}")
        for k, m in modes
    ]
    return table(("structure", ""), rows)
