"""A derivation stated as text: coordinates, a Lagrangian and constraints in `paper.toml`, and what each equation is of it.

    [system]
    coordinates = "theta"
    L = "m*R**2*theta_dot**2/2 + m*g*R*cos(theta)"
    constraints = []                        # each is zero
    forces = []                             # on each coordinate, besides those of L: friction, "-c*theta_dot"
    where = ["omega_0**2 = g/R"]            # what the text says of letters that L does not have

    [system.derives]                        # id → what the printed quantity is
    "1" = "L"
    "2" = "acceleration theta"              # θ̈ from the equations of motion, multipliers eliminated
    "3" = "energy"                          # q̇ ∂L/∂q̇ − L
    "4" = "momentum theta"                  # ∂L/∂θ̇
    "5" = "frequency at theta = 0"          # ω of small oscillations, of several: frequency 2 at …; frequency^2: ω²; period: 2π/ω
    "6" = "motion theta"                    # d/dt ∂L/∂θ̇ − ∂L/∂θ = Q, or what follows from the equations of motion
    "7" = "integral"                        # F with dF/dt = 0 along every motion, as energies and momenta have
    "8" = "small motion theta at theta = 0" # motion, acceleration or momentum through first order about an equilibrium

The constraints, their rates and what `where` says are premises of every verdict, and named in those that need them. A letter of a
print of which nothing is said is refused: what it stands for decides whether the print is right. What is said by the coordinates,
ell = m r² φ̇, changes with them; what an even power alone is said of has no sign, and a print that needs it is refused.

The text is parsed by the reader of expressions; nothing in it runs. Goldstein, Poole & Safko, Classical Mechanics, 3rd ed.,
§§1.4, 2.4, 2.6, 2.7, 6.2.
"""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
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
from lagrotor.paper.latex.formula import read_formula
from lagrotor.paper.latex.printed import paper_notation
from lagrotor.paper.latex.tree import Node, in_catalogue, letters_of, text_of
from lagrotor.paper.letters import read
from lagrotor.paper.premises import Premise

_KEYS = ("coordinates", "L", "constraints", "forces", "where", "derives")
_KIND = re.compile(
    r"(?P<whole>L|energy|integral)|(?P<small>small +)?(?P<kind>momentum|acceleration|motion)(?: +(?P<name>(?!at\b)[A-Za-z_]\w*))?"
    r"(?(small)(?: +at +(?P<about>.*))?)|(?P<form>frequency|frequency\^2|period)(?: +(?P<which>\d+))?(?: +at +(?P<at>.*))?"
)
_LAGRANGIANS = ("L", "Lcal", "Lscr")  # as L is named in a print, where it is no letter of the system


@dataclass(frozen=True)
class StatedSystem:
    """What `paper.toml` states; `derived["2"]` is what it gives for equation 2."""

    c: Coordinates
    L: sp.Expr
    constraints: tuple[sp.Expr, ...]
    forces: tuple[sp.Expr, ...]
    where: tuple[sp.Eq, ...]
    derives: Mapping[str, str]
    names: Mapping[str, Any]
    place: str
    paper: Catalogue

    def __getitem__(self, identifier: str) -> sp.Expr:
        if identifier not in self.derives:
            raise InputError(
                f"{self.place}: derives: equation {identifier} is not there: it has {', '.join(self.derives)}"
            )
        said = self.derives[identifier]
        match = _KIND.fullmatch(_one_line(said))
        if match is None:
            raise InputError(
                f"{self.place}: derives: {said!r} is not known: L, energy, integral, momentum q, acceleration q, "
                "motion q, small motion q at q = 0, frequency at q = 0, or period"
            )
        if not self.paper.equation(identifier).line:
            says = " has no printed line, its print was kept aside: write it as an [[equation.line]] in equations.toml"
            raise self._refusal(identifier, f"{says}, or leave it out here")
        self._check_letters(identifier)
        derived = self._derived(identifier, match)
        self._check_signs(identifier, derived)
        self._check_said(identifier, derived)
        return derived

    def _derived(self, identifier: str, match: re.Match[str]) -> sp.Expr:
        said = match.groupdict(default="")
        if said["whole"] == "integral":
            return self._conserved(identifier)
        if said["whole"]:
            return self.L if said["whole"] == "L" else shortest(energy(self.L, self.c))
        if kind := said["kind"]:
            system = self._small(said["about"]) if said["small"] else self
            derived = system._of_coordinate(kind, said["name"])
            return shortest(system._as_printed(identifier, derived) if kind == "motion" else derived)
        return self._frequency(identifier, said["form"], int(said["which"] or 1), said["at"])

    def _small(self, about: str) -> "StatedSystem":
        """The system with L through second order and the forces through first in q − q₀ and q̇, about an equilibrium q₀."""
        if self.constraints:
            raise InputError(
                f"{self.place}: derives: small motion is of coordinates without constraints: state it in such"
            )
        still, small = self._equilibrium(about), sp.Dummy()
        rest = still | dict.fromkeys(self.c.v, sp.S.Zero)
        near = {x: x0 + small * (x - x0) for x, x0 in rest.items()}

        def through(order: int, e: sp.Expr) -> sp.Expr:
            e = e.xreplace(near)
            return sum((e.diff(small, n).subs(small, 0) / sp.factorial(n) for n in range(order + 1)), sp.S.Zero)

        system = replace(self, L=through(2, self.L), forces=tuple(through(1, each) for each in self.forces))
        if any(each.has(sp.Derivative, sp.Subs, sp.nan, sp.zoo, sp.oo) for each in (system.L, *system.forces)):
            raise InputError(f"{self.place}: derives: L or a force has no series at {about or 'zero'}")
        vars(system)["_fixed"] = self._fixed  # a print may have letters of the terms that are left out
        moved = [
            each for each in system.accelerations.xreplace(rest) if not each.has(t) and not _is_zero(each)
        ]  # undriven
        if moved:
            raise InputError(
                f"{self.place}: derives: {about or 'zero'} is no equilibrium: there it has the acceleration {moved[0]}"
            )
        return system

    def _equilibrium(self, point: str) -> dict[sp.Symbol, sp.Expr]:
        """The coordinates of `at theta = 0, x = a`; those that are not named are zero."""
        at: dict[sp.Symbol, sp.Expr] = {}
        for each in filter(None, (part.strip() for part in point.split(","))):
            name, _, value = each.partition("=")
            at[read(name.strip(), self.names, self.place)] = read(value.strip() or "0", self.names, self.place)
        return dict.fromkeys(self.c.q, sp.S.Zero) | at

    @cached_property
    def premises(self) -> tuple[Premise, ...]:
        """What every print may use: the constraints, which hold at all times, and what is said of letters."""
        kept = [sp.Eq(e, 0) for g in self.constraints for e in (g, total_derivative(g, self.c))]
        said = (each.func(*map(self._along, each.args), evaluate=False) for each in self.where)
        return (
            *([Premise("the constraints hold", where=tuple(kept))] if kept else []),
            *(
                Premise("as the text says", where=(each,), defines=not each.free_symbols <= self._fixed)
                for each in said
            ),
        )

    def _refusal(self, identifier: str, says: str) -> InputError:
        return InputError(f"{self.place}: derives: {identifier}{says}")

    def _check_letters(self, identifier: str) -> None:
        """Raise InputError where a print has a letter of which the system says nothing."""
        known = self._known
        nodes = self._left_nodes(identifier)
        names = {name for node in nodes for name in letters_of(node)}
        printed = set[sp.Basic]()
        if names & {s.name for s in (*self.c.q, *self.c.v, *self.c.a)} and all(map(in_catalogue, nodes)):
            printed = {self.names.get(name, sp.Symbol(name)) for name in names}
        for line in self.paper.lines(identifier):
            letters = printed.union(*(e.free_symbols for e in line.members))
            if strangers := sorted(str(s) for s in letters - known - {line.small}):
                says = f" is printed with {strangers[0]}, of which the system says nothing: say what it is, as in"
                raise self._refusal(
                    identifier, f'{says} where = ["{strangers[0]} = …"], or leave the equation out here'
                )

    def _check_signs(self, identifier: str, derived: sp.Expr) -> None:
        """Raise InputError where a print depends on the sign of a letter of which only an even power is said: r² = x² + y²."""
        for letter in sorted(self._known - self._fixed - {t}, key=str):
            turned = {letter: -letter}
            said = [each.lhs - each.rhs for each in self.where if each.has(letter)]
            if letter.is_nonnegative or any(e != e.xreplace(turned) for e in said):
                continue
            for line in self.paper.lines(identifier):
                for e in (member - derived for member in line.members):
                    if not any(_is_zero(e.xreplace(turned) - sign * e) for sign in (1, -1)):
                        says = f" depends on the sign of {letter}, of which where says an even power only"
                        raise self._refusal(
                            identifier, f'{says}: write "{letter} = …", or positive=True for {letter} in symbols.py'
                        )

    def _check_said(self, identifier: str, derived: sp.Expr) -> None:
        """Raise InputError where a print needs more of its letters than is said: a, where a + b alone is."""
        said = [self._along(each.lhs - each.rhs) for each in self.where]
        letters = sorted(set[sp.Basic]().union(*(e.free_symbols for e in said)) - self._fixed - {t}, key=str)
        slopes = sp.Matrix([[e.diff(s) for s in letters] for e in said])
        for e in (self._along(member - derived) for line in self.paper.lines(identifier) for member in line.members):
            own = sp.Matrix([[e.diff(s) for s in letters]])
            if any(own) and slopes.col_join(own).rank(iszerofunc=_is_zero) > slopes.rank(iszerofunc=_is_zero):
                name = next(s for s in letters if e.has(s))
                only = next(f"{each.lhs} = {each.rhs}" for each in self.where if each.has(name))
                says = f" is printed with {name}, of which where says {only} only: say what {name} is, or leave the equation out"
                raise self._refusal(identifier, says)

    @cached_property
    def _fixed(self) -> set[sp.Basic]:
        """The letters of L, constraints and forces, which are constant, and of the coordinates and their rates."""
        all_of = (self.L, *self.constraints, *self.forces, *self.c.q, *self.c.v, *self.c.a)
        return set[sp.Basic]().union(*(e.free_symbols for e in all_of))

    @cached_property
    def _known(self) -> set[sp.Basic]:
        """The letters of which the system says something, and the time."""
        return self._fixed.union({t}, *(each.free_symbols for each in self.where))

    @cached_property
    def _letter_rates(self) -> Mapping[sp.Symbol, sp.Expr]:
        """The rates of what `where` gives by coordinates: of ell in ell = m r² φ̇, of r in r² = x² + y²; other letters rest.

        A rate that the relations do not give holds symbols of its own.
        """
        relations = [self._along(each.lhs - each.rhs) for each in self.where]
        moving: set[sp.Basic] = {*self.c.q, *self.c.v, t}
        while more := {s for e in relations if e.free_symbols & moving for s in e.free_symbols} - self._fixed - moving:
            moving |= more
        letters = sorted(moving - {*self.c.q, *self.c.v, t}, key=str)
        unknown = sp.symbols(f"rate_1:{len(letters) + 1}", cls=sp.Dummy)
        pairs = [*zip(letters, unknown, strict=True)]
        rows = [total_derivative(e, self.c) + sum(e.diff(s) * rate for s, rate in pairs) for e in relations]
        rows = [self._along(row) for row in rows if row != 0]
        solutions = list(sp.linsolve(rows, unknown)) if pairs else [()]
        return dict(zip(letters, solutions[0] if solutions else unknown, strict=True))

    def _rate(self, e: sp.Expr) -> sp.Expr:
        """de/dt along the motion. Raises InputError where it has a letter whose rate is not known."""
        e = self._along(e)
        rates = {s: rate for s, rate in self._letter_rates.items() if e.has(s)}
        for letter, rate in rates.items():
            if rate.atoms(sp.Dummy):
                raise InputError(
                    f'{self.place}: where does not say how {letter} changes: write "{letter} = …" in the coordinates'
                )
        return self._along(total_derivative(e, self.c) + sum(e.diff(s) * rate for s, rate in rates.items()))

    def _conserved(self, identifier: str) -> sp.Expr:
        """A printed F less what it has changed by after a short time: F itself where dF/dt = 0 along every motion."""
        line = self.paper.lines(identifier)[0]
        F = line.members[0] if line.members else sp.S.Zero
        moving = {s for s in self._letter_rates if F.has(s)}
        if not moving and not F.has(*self.c.q, *self.c.v):
            raise self._refusal(identifier, f": {F} depends on no coordinate or velocity: leave it out here")
        rate = self._rate(F)
        if _is_zero(rate):  # by what is said of its letters, which is then a premise
            rate = sum((each.lhs - each.rhs for each in self.where if each.free_symbols & moving), sp.S.Zero)
        time = next(name for name in ("tau", "short_time", "time_since") if name not in self.names)
        return F - sp.Symbol(time, positive=True) * rate

    def _of_coordinate(self, kind: str, which: str) -> sp.Expr:
        place = next((n for n, q in enumerate(self.c.q) if q.name == which), None)
        if place is None:
            known = ", ".join(map(str, self.c.q))
            raise InputError(f"{self.place}: derives: {kind} {which or '?'}: the coordinates are {known}")
        rows: dict[str, Callable[[], sp.Matrix]] = {
            "momentum": lambda: momenta(self.L, self.c),
            "motion": lambda: self._motion,
            "acceleration": lambda: self.accelerations,
        }
        return rows[kind]()[place]

    def _as_printed(self, identifier: str, motion: sp.Expr) -> sp.Expr:
        """What a print left = right of an equation of motion has on its right: right itself where left − right is zero with the
        accelerations of the motion put in. A name for it, Q = m a + …, has the motion itself on its right.
        """
        (line, *more), left = self.paper.lines(identifier), self._left_side(identifier)
        right = line.members[-1]
        if left is not None and not more:
            if not any(each.has(*self.c.a) for each in line.members):
                self._check_constraint(identifier, [left - each for each in line.members])
                return self._along(left)
            if len(line.members) == 1:
                return right + self._along(left - right)
        if all(_is_zero(each - motion) for each in line.members):
            return motion
        reason = "its left side is no single expression in the coordinates: say what its letters are in where"
        if left is not None:
            reason = "has an acceleration in one of several members: print one equation"
        raise self._refusal(identifier, f" is printed as … = {right}, and {reason}, or leave it out here")

    def _check_constraint(self, identifier: str, differences: Sequence[sp.Expr]) -> None:
        """Raise InputError where a print is a constraint or its rate, which is stated and not derived."""
        kept = [each.lhs for premise in self.premises[:1] if self.constraints for each in premise.where]
        if any(not sp.cancel(e / each).has(*self.c.q, *self.c.v) for e in differences for each in kept if e != 0):
            raise self._refusal(
                identifier, " is a constraint itself, which is stated and not derived: leave it out here"
            )

    def _along(self, e: sp.Expr) -> sp.Expr:
        """An expression with the accelerations of the motion put in."""
        if not e.has(*self.c.a):
            return shortest(e)
        return shortest(e.xreplace(dict(zip(self.c.a, self.accelerations, strict=True))))

    def _left_nodes(self, identifier: str) -> tuple[Node, ...]:
        """The sides of a print before its first member: p_θ, d/dt ∂L/∂θ̇."""
        entries = self.paper.equations
        notation = paper_notation((e.latex for e in entries.values()), self.paper.about.notation, self.place)
        reading = read_formula(entries[identifier].line[0]["quantity"], notation)
        return tuple(side.node for statement in reading.statements for side in statement.sides)

    def _left_side(self, identifier: str) -> sp.Expr | None:
        """The left side of a print in the coordinates and letters that are said; None where it is none, or they are two."""

        def partial(f: sp.Expr, by: sp.Symbol, order: int = 1) -> sp.Expr:
            if by == t:
                return reduce(lambda e, _: self._rate(e), range(int(order)), f)
            if isinstance(f, sp.Symbol) and f.name in _LAGRANGIANS and f not in self._known:
                f = self.L
            return sp.diff(f, by, int(order))

        said = {name: sp.Symbol(name) for name in _LAGRANGIANS}
        said |= {name: s for name, s in self.names.items() if s in self._known}
        said |= {"t": t, "rate": self._rate, "Derivative": partial}
        try:
            left, *others = (read(text_of(node), said, self.place) for node in self._left_nodes(identifier))
        except InputError:  # it has a letter of its own
            return None
        same = all(_is_zero(self._along(left - each)) for each in others)
        return left if same and left.free_symbols <= self._known else None

    @property
    def _motion(self) -> sp.Matrix:
        """d/dt ∂L/∂q̇ − ∂L/∂q − Q, without the forces of constraints."""
        return euler_lagrange(self.L, self.c) - sp.Matrix(self.forces)

    @cached_property
    def accelerations(self) -> sp.Matrix:
        """a of M a + h = Gᵀ λ with the constraints differentiated twice, the multipliers λ eliminated."""
        motion = self._motion
        multipliers = sp.symbols(f"multiplier_1:{len(self.constraints) + 1}")
        for multiplier, constraint in zip(multipliers, self.constraints, strict=True):
            motion -= multiplier * gradient(constraint, self.c.q)
        kept = [total_derivative(total_derivative(each, self.c), self.c) for each in self.constraints]
        rows, unknown = sp.Matrix([*motion, *kept]), sp.Matrix([*self.c.a, *multipliers])
        matrix = rows.jacobian(unknown)
        solved = linear_solve(
            matrix, -rows.subs(dict.fromkeys(unknown, 0)), f"{self.place}: its equations of motion are singular"
        )
        return sp.Matrix(solved[: len(self.c.q)])

    def _frequency(self, identifier: str, form: str, which: int, point: str) -> sp.Expr:
        """ω of a small oscillation about an equilibrium, ω², or its period: rate = i ω."""
        if any(force.has(*self.c.v) for force in self.forces):
            raise InputError(
                f"{self.place}: derives: with friction small motion has no one frequency: leave frequencies out here"
            )
        system = System(self.c, self.L, constraints=self.constraints, forces=self.forces)
        modes = system.linearise(self._equilibrium(point)).modes()
        squares = list(dict.fromkeys(sp.factor(-(mode.rate**2)) for mode in modes if mode.rate != 0))
        if not 0 < which <= len(squares):
            raise InputError(f"{self.place}: derives: there is no {form} {which}: the system has {len(squares)}")
        squares.sort(key=sp.default_sort_key)
        square = squares[which - 1]
        derived = {"frequency": sp.sqrt(square), "frequency^2": square, "period": 2 * sp.pi * sp.sqrt(1 / square)}[form]
        self._check_frequency(identifier, derived, squares, which, form)
        return derived

    def _check_frequency(
        self, identifier: str, derived: sp.Expr, squares: Sequence[sp.Expr], which: int, form: str
    ) -> None:
        """Raise InputError where a print is another of ω, ω² and the period, or where its sign or its place in the row is."""
        square, put = squares[which - 1], {each.lhs: each.rhs for each in self.where if each.lhs.is_Symbol}
        for member in (e.xreplace(put) for line in self.paper.lines(identifier) for e in line.members):
            if member == 0 or _is_zero(member - derived) or _is_zero(member + derived):
                continue
            power = {"frequency": member**2, "frequency^2": member, "period": (2 * sp.pi / member) ** 2}[form]
            others = {f"{form} {n}, not {which}": power - each for n, each in enumerate(squares, 1) if n != which}
            if form != "frequency^2":
                says = f"{member}, which may be negative: write positive=True for its letters in symbols.py"
                others |= {says: power - square}
            if form == "frequency":
                others |= {
                    "a square: say frequency^2": member - square,
                    "a period: say period": (2 * sp.pi / member) ** 2 - square,
                    "turns by time, not radians: leave it out here": (2 * sp.pi * member) ** 2 - square,
                }
            for says, difference in others.items():
                if _is_zero(difference):
                    raise self._refusal(identifier, f" prints {says}")


def _is_zero(e: sp.Expr) -> bool:
    return decide_equal(e, sp.S.Zero).answer == "zero"


def stated_system(paper: Catalogue) -> StatedSystem:
    """The system of a paper's folder. Raises InputError where none is stated, or one that cannot be read."""
    given, where = paper.about.system, f"{paper.folder / 'paper.toml'}: system"
    if unknown := sorted(given.keys() - set(_KEYS)):
        raise InputError(f"{where}: {unknown[0]!r} means nothing here: the keys are {', '.join(_KEYS)}")
    if missing := [key for key in ("coordinates", "L") if not given.get(key)]:
        raise InputError(
            f"{where}: {missing[0]} is missing: state the coordinates and the Lagrangian L, as in "
            '[system] coordinates = "theta", L = "m*l**2*theta_dot**2/2 + m*g*l*cos(theta)"'
        )
    known = {symbol.name: symbol for symbol in paper.glossary}
    fresh = coordinates(given["coordinates"])
    c = Coordinates(*(tuple(known.get(s.name, s) for s in row) for row in (fresh.q, fresh.v, fresh.a)))
    names = known | {s.name: s for row in (c.q, c.v, c.a) for s in row}
    for identifier in given.get("derives", {}):
        paper.equation(identifier)
    forces = tuple(read(each, names, f"{where}: forces") for each in given.get("forces", ())) or (sp.S.Zero,) * len(c.q)
    if len(forces) != len(c.q):
        raise InputError(
            f'{where}: forces: {len(forces)} are given for {len(c.q)} coordinates: give each its own, "0" where none is'
        )
    system = StatedSystem(
        c,
        read(given["L"], names, f"{where}: L"),
        tuple(read(each, names, f"{where}: constraints") for each in given.get("constraints", ())),
        forces,
        tuple(_relation(each, names, f"{where}: where") for each in given.get("where", ())),
        given.get("derives", {}),
        names,
        where,
        paper,
    )
    for each in system.where:
        moves = each.has(*c.q, *c.v, *c.a)
        if moves and (each.lhs in system._fixed - {*c.q, *c.v, *c.a} or each.free_symbols <= system._fixed):
            raise InputError(
                f"{where}: where: {each.lhs} = {each.rhs} is about the motion and letters of L alone, which are constant: write "
                "it out in L, or state it in constraints"
            )
    return system


def _relation(text: str, names: Mapping[str, Any], where: str) -> sp.Eq:
    """left = right, of two expressions. Raises InputError for anything else."""
    sides = str(text).split("=")
    if len(sides) != 2:
        raise InputError(f"{where}: {text!r} must be one equation: left = right")
    left, right = (read(side.strip(), names, where) for side in sides)
    return sp.Eq(left, right, evaluate=False)


def stated(script: str) -> StatedSystem:
    """The system of the paper whose folder holds `derivations/` with this script."""
    return stated_system(Catalogue(Path(script).resolve().parent.parent))


_HEAD = """# %% [markdown]
# # The system that paper.toml states
#
# Written by `lagrotor derive`; change paper.toml, not this.

# %%
from lagrotor.paper import verdict
from lagrotor.paper.latex.stated_system import stated

system = stated(__file__)
"""
_CELL = """
# %% [markdown]
# ## ({title}): {said}

# %%
verdict({id}, system[{id}]{premises})
"""


_PROPOSAL = """
# The Lagrangian of ({id}) and what seems to be derived from it. Without the marks `# ` this is a derivation without Python, which
# `lagrotor derive` makes a script of: see README.md.
# [system]
# coordinates = "{names}"
# L = {L}
# forces = []  # on each coordinate, besides those of L, as in "-c*theta_dot"
# where = []  # what the text says of letters that L does not have, as in "omega_0**2 = g/l"
# [system.derives]
"""


def proposed_system(rows: Sequence[Mapping[str, Any]]) -> str:
    """The table `[system]` of a paper that prints a Lagrangian, in comments; nothing where none of its equations is one.

    rows: of equations.toml. A coordinate is what L has the rate of; the rest goes by the usual letters.
    """
    lines = [(row["id"], line) for row in rows for line in row.get("line", ())]
    is_lagrangian = re.compile(r"(?:\\mathcal|\\mathscr)?\s*\{?\s*L\s*\}?\s*(?:\(.*\))?")
    for identifier, line in lines:
        member = next((each for each in line.get("members", ()) if "_dot" in each), "")
        if not is_lagrangian.fullmatch(line["quantity"].strip()) or not member:
            continue
        names = sorted(set(re.findall(r"(\w+)_dot\b", member)), key=lambda name: member.index(f"{name}_dot"))
        bent = {name for name in names if re.search(rf"\b(?:sin|cos)\([^()]*\b{name}\b", member)}
        seems = [(i, "L" if each is line else _seems(each, names, bent)) for i, each in lines]
        derives = [f"# {json.dumps(i)} = {json.dumps(said)}" for i, said in seems if said]
        head = _PROPOSAL.format(id=identifier, names=" ".join(names), L=json.dumps(member))
        return head + "".join(f"{row}\n" for row in dict.fromkeys(derives))
    return ""


def _seems(line: Mapping[str, Any], names: Sequence[str], bent: set[str]) -> str:
    """What a printed line seems to be of a system with these coordinates; "" where it does not seem to be anything.

    bent: those of which L has the sine or cosine: an equation of motion without one is of small motion.
    """
    quantity = re.sub(r"[\s{}\\]|mathcal|mathscr", "", line["quantity"])
    members = " ".join(line.get("members", ()))
    if quantity in ("E", "H", "h") and "_dot" in members:
        return "energy"
    momentum = re.search(r"(?:^p_|partialLpartialdot)(\w+)$", quantity)
    if momentum and momentum[1] in names:
        return f"momentum {momentum[1]}"
    turning = {name for name in names if f"ddot{name}" in quantity or f"{name}_ddot" in members}
    small = "small " if turning & bent and not re.search(r"sin|cos", quantity + members) else ""
    if quantity.startswith("ddot") and quantity[4:] in names:
        return f"{small}acceleration {quantity[4:]}"
    return f"{small}motion {min(turning)}" if len(turning) == 1 else ""


def _one_line(text: str) -> str:
    return " ".join(text.split())


def write_derivation(paper: Catalogue) -> tuple[Path, dict[str, str]]:
    """Write `derivations/s_system.py`, in which each equation of [system.derives] is stated that can be judged.

    Also id → why of those that are left out. Raises what reading raises, and InputError where none can be judged.
    """
    system, cells, refused = stated_system(paper), "", dict[str, str]()
    premises = ", premises=system.premises" if system.premises else ""
    for i, said in system.derives.items():
        try:
            _ = system[i]
        except (InputError, SingularError) as error:
            refused[i] = str(error)
        else:
            cells += _CELL.format(title=_one_line(i), said=_one_line(said), id=json.dumps(i), premises=premises)
    if refused and not cells:
        raise InputError("; ".join(dict.fromkeys(refused.values())))
    folder = paper.folder / "derivations"
    folder.mkdir(exist_ok=True)
    return write_text(folder / f"{paper.about.equations_in}_system.py", _HEAD + cells), refused
