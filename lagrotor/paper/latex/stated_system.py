"""A derivation without Python: `paper.toml` states coordinates, a Lagrangian, constraints and the role of each equation.

    [system]
    coordinates = "theta"
    L = "m*R**2*theta_dot**2/2 + m*g*R*cos(theta)"
    constraints = []                        # each expression is zero
    forces = []                             # one per coordinate, in addition to L: friction, "-c*theta_dot"
    where = ["omega_0 = sqrt(g/R)"]         # definitions of symbols outside L, by constants

    [system.derives]                        # equation id → the printed quantity
    "1" = "L"
    "2" = "acceleration theta"              # θ̈ from the equations of motion, multipliers eliminated
    "3" = "energy"                          # q̇ ∂L/∂q̇ − L
    "4" = "momentum theta"                  # ∂L/∂θ̇
    "5" = "frequency at theta = 0"          # ω of small oscillations; of several: frequency 2 at …; frequency^2: ω²; period: 2π/ω
    "6" = "motion theta"                    # any equation that follows from the equations of motion
    "7" = "integral"                        # F with dF/dt = 0 along every motion

The constraints, their rates and the definitions are premises of every verdict; a verdict names those that it needs. An
equation with a symbol outside the system and the definitions is refused, because the symbol's value decides the verdict.

The text is parsed by the reader of expressions and never executed. Goldstein, Poole & Safko, Classical Mechanics, 3rd ed.,
§§1.4, 2.4, 2.6, 2.7, 6.2.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, reduce
from pathlib import Path
from typing import Any

import sympy as sp

from lagrotor.algebra import decide_equal
from lagrotor.errors import InputError, SingularError
from lagrotor.files import write_text
from lagrotor.mechanics.expressions import shortest
from lagrotor.mechanics.lagrangian import (
    Coordinates,
    coordinates,
    energy,
    euler_lagrange,
    gradient,
    linear_solve,
    momenta,
    t,
    total_derivative,
)
from lagrotor.mechanics.systems import System
from lagrotor.paper.catalogue import Catalogue
from lagrotor.paper.grammar import read
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.readings import paper_notation
from lagrotor.paper.latex.tree import text_of
from lagrotor.paper.premises import Premise

_KEYS = ("coordinates", "L", "constraints", "forces", "where", "derives")
_ROLE = re.compile(
    r"(?P<whole>L|energy|integral)|(?P<kind>momentum|acceleration|motion)(?: +(?P<name>[A-Za-z_]\w*))?"
    r"|(?P<form>frequency|frequency\^2|period)(?: +(?P<which>\d+))?(?: +at +(?P<at>.*))?"
)
_ROLES = "L, energy, integral, momentum q, acceleration q, motion q, frequency at q = 0, frequency^2 or period"
_LAGRANGIANS = ("L", "Lcal", "Lscr")  # printed names of L, unless the system has such a symbol


@dataclass(frozen=True)
class StatedSystem:
    """The system that a paper's `paper.toml` states; `system["2"]` is the expression that it gives for equation 2.

    c: the coordinates. L: the Lagrangian. constraints: expressions that are zero. forces: one per coordinate. where:
    symbol → its definition. derives: id → role of the equation. names: name → symbol. place: the file, for messages.
    """

    c: Coordinates
    L: sp.Expr
    constraints: tuple[sp.Expr, ...]
    forces: tuple[sp.Expr, ...]
    where: Mapping[sp.Symbol, sp.Expr]
    derives: Mapping[str, str]
    names: Mapping[str, Any]
    place: str
    paper: Catalogue

    def __getitem__(self, identifier: str) -> sp.Expr:
        """Return the expression that the system gives for the quantity of an equation, to be compared with its members.

        Raises
        ------
        InputError
            If the equation has no role, or this system cannot decide it.
        """
        if identifier not in self.derives:
            helps = f"give it a role in [system.derives], where {', '.join(self.derives) or 'none'} have one"
            raise self._error(f"equation {identifier} has no role: {helps}")
        role = _ROLE.fullmatch(_one_line(self.derives[identifier]))
        if role is None:
            raise self._error(f"the role {self.derives[identifier]!r} is unknown: write {_ROLES}")
        self._check_letters(identifier)
        words = role.groupdict(default="")
        if words["form"]:
            return self._frequency(words["form"], int(words["which"] or 1), words["at"])
        if words["whole"] == "integral":
            return self._integral(identifier)
        if words["whole"]:
            return self.L if words["whole"] == "L" else shortest(energy(self.L, self.c))
        names = [q.name for q in self.c.q]
        if words["name"] not in names:
            helps = f"write one of the coordinates {', '.join(names)}"
            raise self._error(f"{words['kind']} {words['name'] or '?'} names no coordinate: {helps}")
        if words["kind"] == "motion":
            return shortest(self._motion_equation(identifier))
        rows = momenta(self.L, self.c) if words["kind"] == "momentum" else self.accelerations
        return shortest(rows[names.index(words["name"])])

    @cached_property
    def premises(self) -> tuple[Premise, ...]:
        """The premises of every equation: the constraints and their rates are zero, and the definitions hold."""
        rates = [sp.Eq(e, 0) for g in self.constraints for e in (g, total_derivative(g, self.c))]
        definitions = (sp.Eq(letter, value, evaluate=False) for letter, value in self.where.items())
        return (
            *([Premise("the constraints hold", where=tuple(rates))] if rates else []),
            *(Premise("as the text says", where=(definition,), defines=True) for definition in definitions),
        )

    @cached_property
    def accelerations(self) -> sp.Matrix:
        """The accelerations a, which solve M a + h = Gᵀ λ and the twice differentiated constraints; λ is eliminated."""
        multipliers = sp.symbols(f"multiplier_1:{len(self.constraints) + 1}")
        rows = euler_lagrange(self.L, self.c) - sp.Matrix(self.forces)
        for multiplier, constraint in zip(multipliers, self.constraints, strict=True):
            rows -= multiplier * gradient(constraint, self.c.q)
        second = [total_derivative(total_derivative(g, self.c), self.c) for g in self.constraints]
        equations, unknown = sp.Matrix([*rows, *second]), sp.Matrix([*self.c.a, *multipliers])
        singular = f"{self.place}: its equations of motion are singular"
        solution = linear_solve(equations.jacobian(unknown), -equations.subs(dict.fromkeys(unknown, 0)), singular)
        return sp.Matrix(solution[: len(self.c.q)])

    def _error(self, says: str) -> InputError:
        return InputError(f"{self.place}: derives: {says}")

    @cached_property
    def _known(self) -> set[sp.Basic]:
        """The symbols that an equation may contain: those of the system and its definitions, coordinates, rates, time."""
        expressions = (self.L, *self.constraints, *self.forces, *self.where.values(), *self.where)
        return {t, *self.c.q, *self.c.v, *self.c.a}.union(*(e.free_symbols for e in expressions))

    def _check_letters(self, identifier: str) -> None:
        """Raise InputError if an equation has no printed line, or if the system does not define one of its symbols."""
        if not self.paper.equation(identifier).line:
            says = "has no printed line: write it as an [[equation.line]] in equations.toml, or remove it here"
            raise self._error(f"equation {identifier} {says}")
        for line in self.paper.lines(identifier):
            letters = set[sp.Basic]().union(*(e.free_symbols for e in line.members))
            for name in sorted(str(s) for s in letters - self._known - {line.small}):
                says = (
                    f'is printed with {name}, which the system does not define: define it, as in where = ["{name} = …"]'
                )
                raise self._error(f"equation {identifier} {says}, or remove the equation here")

    def _point(self, text: str) -> dict[sp.Symbol, sp.Expr]:
        """Return the point that a text such as "theta = 0, x = a" states; a coordinate that it leaves out is zero."""
        values = dict.fromkeys(self.c.q, sp.S.Zero)
        for assignment in filter(None, (piece.strip() for piece in text.split(","))):
            name, _, value = assignment.partition("=")
            values[read(name.strip(), self.names, self.place)] = read(value.strip() or "0", self.names, self.place)
        return values

    def _along(self, e: sp.Expr) -> sp.Expr:
        """Return an expression in which the accelerations are replaced by those of the equations of motion."""
        return shortest(e.xreplace(dict(zip(self.c.a, self.accelerations, strict=True))) if e.has(*self.c.a) else e)

    def _rate(self, e: sp.Expr) -> sp.Expr:
        """Return the time derivative of an expression along the motion."""
        return self._along(total_derivative(self._along(e), self.c))

    def _integral(self, identifier: str) -> sp.Expr:
        """Return F − τ dF/dt along the motion, where F is the printed member; it equals F if F is conserved."""
        F = self.paper.lines(identifier)[0].members[0]
        if not F.has(*self.c.q, *self.c.v):
            says = f"has the expression {F}, which depends on no coordinate or velocity: remove the equation here"
            raise self._error(f"equation {identifier} {says}")
        time = next(name for name in ("tau", "short_time", "time_since") if name not in self.names)
        return F - sp.Symbol(time, positive=True) * self._rate(F)

    def _motion_equation(self, identifier: str) -> sp.Expr:
        """Return the expression with which the right side of a printed equation of motion is compared.

        It is right + (left − right), with the derived accelerations in the difference. If no member has an acceleration,
        it is the left side with the derived accelerations.
        """
        (line, *further), lhs = self.paper.lines(identifier), self._left_side(identifier)
        moving = any(member.has(*self.c.a) for member in line.members)
        if lhs is None or further or (moving and len(line.members) > 1):
            says = (
                "has no single left side in the symbols of the system, or it has accelerations in a chain of equations"
            )
            helps = "print one equation, define its symbols in where, or remove it here"
            raise self._error(f"equation {identifier} {says}: {helps}")
        return line.members[0] + self._along(lhs - line.members[0]) if moving else self._along(lhs)

    def _left_side(self, identifier: str) -> sp.Expr | None:
        """Return the left side of an equation; None if it has symbols outside the system, or several sides that differ."""

        def partial(f: sp.Expr, by: sp.Symbol, order: int = 1) -> sp.Expr:
            if by == t:
                return reduce(lambda e, _: self._rate(e), range(int(order)), f)
            is_L = isinstance(f, sp.Symbol) and f.name in _LAGRANGIANS and f not in self._known
            return sp.diff(self.L if is_L else f, by, int(order))

        entries = self.paper.equations
        notation = paper_notation((e.latex for e in entries.values()), self.paper.about.notation, self.place)
        reading = read_formula(entries[identifier].line[0]["quantity"], notation)
        names = {name: sp.Symbol(name) for name in _LAGRANGIANS} | {"t": t, "rate": self._rate, "Derivative": partial}
        names |= {name: symbol for name, symbol in self.names.items() if symbol in self._known}
        texts = [text_of(side.node) for statement in reading.statements for side in statement.sides]
        try:
            lhs, *others = (read(text, names, self.place) for text in texts)
        except (InputError, ValueError):
            return None
        same = all(_is_zero(self._along(lhs - value)) for value in others)
        return lhs if same and lhs.free_symbols <= self._known else None

    def _frequency(self, form: str, which: int, point: str) -> sp.Expr:
        """Return ω, ω² or the period 2π/ω of a small oscillation about the equilibrium that `point` states.

        form: "frequency", "frequency^2" or "period". which: the number of the oscillation, from 1, in the order of ω².
        """
        if any(force.has(*self.c.v) for force in self.forces):
            raise self._error("a system with friction has no frequency of small oscillations: remove the equation here")
        system = System(self.c, self.L, constraints=self.constraints, forces=self.forces)
        modes = system.linearise(self._point(point)).modes()
        squares = sorted({sp.factor(-(mode.rate**2)) for mode in modes if mode.rate != 0}, key=sp.default_sort_key)
        if not 0 < which <= len(squares):
            helps = "correct the number, or remove the equation here"
            raise self._error(f"there is no {form} {which}: the system has {len(squares)}: {helps}")
        square = squares[which - 1]
        if form == "frequency^2":
            return square
        return sp.sqrt(square) if form == "frequency" else 2 * sp.pi * sp.sqrt(1 / square)


def _is_zero(e: sp.Expr) -> bool:
    return decide_equal(e, sp.S.Zero).answer == "zero"


def stated_system(paper: Catalogue) -> StatedSystem:
    """Return the system that a paper's `paper.toml` states.

    Raises
    ------
    InputError
        If `paper.toml` states no system, or if a key, an expression or a definition in it cannot be read.
    """
    table, where = paper.about.system, f"{paper.folder / 'paper.toml'}: system"
    if unknown := sorted(table.keys() - set(_KEYS)):
        raise InputError(f"{where}: {unknown[0]!r} is not a key of [system]: the keys are {', '.join(_KEYS)}")
    if missing := [key for key in ("coordinates", "L") if not table.get(key)]:
        raise InputError(
            f"{where}: {missing[0]} is missing: state the coordinates and the Lagrangian L, as in "
            '[system] coordinates = "theta", L = "m*l**2*theta_dot**2/2 + m*g*l*cos(theta)"'
        )
    symbols = {symbol.name: symbol for symbol in paper.glossary}
    fresh = coordinates(table["coordinates"])
    c = Coordinates(*(tuple(symbols.get(s.name, s) for s in row) for row in (fresh.q, fresh.v, fresh.a)))
    names = symbols | {s.name: s for row in (c.q, c.v, c.a) for s in row}
    for identifier in table.get("derives", {}):
        paper.equation(identifier)
    forces = tuple(read(text, names, f"{where}: forces") for text in table.get("forces", ())) or (sp.S.Zero,) * len(c.q)
    if len(forces) != len(c.q):
        raise InputError(
            f'{where}: forces: {len(forces)} for {len(c.q)} coordinates: write one for each, "0" where none acts'
        )
    L = read(table["L"], names, f"{where}: L")
    constraints = tuple(read(text, names, f"{where}: constraints") for text in table.get("constraints", ()))
    fixed = set[sp.Basic]().union(*(e.free_symbols for e in (L, *constraints, *forces, *c.q, *c.v, *c.a)))
    definitions = _definitions(table.get("where", ()), names, fixed, c, f"{where}: where")
    return StatedSystem(c, L, constraints, forces, definitions, table.get("derives", {}), names, where, paper)


def _definitions(
    rows: tuple[str, ...], names: Mapping[str, Any], fixed: set[sp.Basic], c: Coordinates, where: str
) -> dict[sp.Symbol, sp.Expr]:
    """Return a map from each symbol that a row defines to its definition in constants.

    Raises InputError if a row redefines a symbol, defines one of the system (`fixed`), or uses a coordinate.
    """
    definitions: dict[sp.Symbol, sp.Expr] = {}
    for row in rows:
        name, equals, text = str(row).partition("=")
        letter = names.get(name.strip())
        if not equals or "=" in text or not isinstance(letter, sp.Symbol):
            raise InputError(
                f'{where}: {row!r} defines no symbol of symbols.py: write a definition, as in "omega_0 = sqrt(g/l)"'
            )
        value = read(text.strip(), names, where)
        problems = {
            "is defined twice": letter in definitions,
            "is a symbol of the system": letter in fixed,
            "is defined by coordinates": value.free_symbols & {*c.q, *c.v, *c.a, t},
        }
        if problem := next((words for words, holds in problems.items() if holds), ""):
            raise InputError(f"{where}: {row!r}: {letter} {problem}: write the expression in L or in the equation")
        definitions[letter] = value
    return definitions


def stated(script: str) -> StatedSystem:
    """Return the stated system of the paper to which a derivation belongs.

    Parameters
    ----------
    script : str
        The derivation's `__file__`, in the folder `derivations/` of the paper.

    Returns
    -------
    StatedSystem
        The system in the paper's `paper.toml`.
    """
    return stated_system(Catalogue(Path(script).resolve().parent.parent))


_HEAD = """# %% [markdown]
# # The system that paper.toml states
#
# Written by `lagrotor derive`; change paper.toml, not this.

# %%
from lagrotor.paper import stated, verdict

system = stated(__file__)
"""
_CELL = """
# %% [markdown]
# ## ({title}): {role}

# %%
verdict({id}, system[{id}]{premises})
"""


def _one_line(text: str) -> str:
    return " ".join(text.split())


def write_derivation(paper: Catalogue) -> tuple[Path, dict[str, str]]:
    """Write `derivations/s_system.py`, with a verdict for each equation of [system.derives] that can be decided.

    Return the script, and {id of an equation left out: reason}. Raise InputError if none can be decided.
    """
    system, cells, refused = stated_system(paper), "", dict[str, str]()
    premises = ", premises=system.premises" if system.premises else ""
    for i, role in system.derives.items():
        try:
            _ = system[i]
        except (InputError, SingularError) as error:
            refused[i] = str(error)
        else:
            cells += _CELL.format(title=_one_line(i), role=_one_line(role), id=json.dumps(i), premises=premises)
    if refused and not cells:
        raise InputError("; ".join(dict.fromkeys(refused.values())))
    folder = paper.folder / "derivations"
    folder.mkdir(exist_ok=True)
    return write_text(folder / f"{paper.about.equations_in}_system.py", _HEAD + cells), refused
