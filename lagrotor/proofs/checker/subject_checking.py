"""What a theorem is about: the program's rates are those of the scene, the structure, the Lagrangian or the words that it names.

Decided as `reversals` decides, modulo a prime. The program of a scene or structure is generated again from its numbers; of a
Lagrangian the equations of Lagrange, with d'Alembert's principle where there are constraints, are formed from its words.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

from flint import arb, arb_mat, fmpz_mod_ctx, fmpz_mod_mat

from lagrotor.pair.scene import Link, Rotor, Scene, Shock
from lagrotor.proofs.checker.bounded_series import Dual, Rest, evaluated
from lagrotor.proofs.checker.certified_sets import balls, number, read_ball, term
from lagrotor.proofs.checker.expression_tapes import Words
from lagrotor.proofs.checker.reversals import points_of
from lagrotor.proofs.checker.tapes import ZERO, demand, is_name, read_tape
from lagrotor.proofs.fields import Field, field_of, structure_program
from lagrotor.structures.assembly import Assembly, Brace

Ball = Any


def check_subject(certificate: Any) -> None:
    """The program is that of what is named; of no name its digest stands for it."""
    arguments, rates = certificate["motion"]["arguments"], certificate["motion"]["outputs"]
    if "t" in arguments:
        place, starts = arguments.index("t"), certificate.get("start", {}).get("middle", [])
        own = place < len(rates) and certificate["motion"]["operations"][rates[place]] == ["number", "1"]
        demand(own and place < len(starts) and read_ball(starts[place]).is_zero(), "t is not the time from 0 on")
        demand(read_ball(certificate["start"]["spread"][place]).is_zero(), "t is not the time from 0 on")
    about = certificate["about"]
    if about is None:
        demand(certificate.get("observed") is None, "what is observed has no meaning")
        return
    demand(type(about) is dict and len(about) == 1, "a theorem is about one thing")
    (kind,) = about
    _RULES[kind](certificate, about[kind])


def _rates(words: Words, certificate: Any) -> list[int]:
    """The places of the states' rates in the certificate's program."""
    outputs = words.include(read_tape(certificate["motion"]))
    if certificate["kind"] == "periodic orbit":  # in units of a pace
        return [words.over(place, len(outputs)) for place in outputs]
    return outputs


def residues(words: Words, places: Sequence[int]) -> Iterator[tuple[list[int], int]]:
    """Of results modulo a prime, and the prime, for each sign of roots.

    What is known to be positive comes from earlier results: the program's, along whose motion it was so, not from what is named.
    """
    for point in points_of(words.tape(places)):
        yield [x.value for x in point.outputs([])], point.p


def demand_equal(words: Words, first: Sequence[int], second: Sequence[int], what: str) -> None:
    """Results, each the same function of the arguments as another."""
    demand(len(first) == len(second), what)
    for values, _ in residues(words, [*first, *second]):
        demand(values[: len(first)] == values[len(first) :], what)


def _check_start(certificate: Any, words: Words, held: Sequence[int]) -> None:
    """Along one motion what stays zero may be so at the start; of an orbit or a rest none is shown."""
    if certificate["kind"] in ("periodic orbit", "equilibrium"):
        demand(len(held) == 0, "a rest or an orbit is not shown to keep constraints")
        return
    spread = balls(certificate["start"]["spread"])
    found = _values(words, held, [x + y for x, y in zip(_middle(certificate), spread, strict=True)], certificate)
    demand(all(x.contains(0) for x in found), "the start is off the constraints")


def _middle(certificate: Any) -> list[Ball]:
    """Of the start or of the rest."""
    if certificate["kind"] == "equilibrium":
        at = [number(x) for x in certificate["middle"]]
        return [*at, *[ZERO] * len(at)]
    return balls(certificate["start"]["middle"])


def _values(words: Words, places: Sequence[int], at: Sequence[Ball], certificate: Any) -> list[Ball]:
    """Results at a start, whose letters are 1. Raises NotProved where one is not defined."""
    known = [*at, *balls(certificate["motion"]["parameters"])]
    each = [*known, *[arb(1)] * (len(words.arguments) - len(known))]
    found = [x.value.at_start() for x in evaluated(words.tape(places), [Dual(Rest([x], ZERO, 1)) for x in each])]
    demand(all(x.is_finite() for x in found), "what is named is not defined at the start")
    return found


def _check_generated(certificate: Any, made: Field) -> None:
    """The program that is generated for a scene or structure, and what is observed of it."""
    arguments, observed = certificate["motion"]["arguments"], certificate.get("observed")
    words = Words(arguments, None)
    rates, what = _rates(words, certificate), "the program is not that of what the theorem names"
    demand(arguments[: len(rates)] == [str(s) for s in made.states], what)
    demand_equal(words, rates, words.include(read_tape(vars(made.motion.tape))), what)
    held = words.include(read_tape(vars(made.function(made.held))))
    _check_start(certificate, words, held)
    if observed is not None:
        seen = [*(made.seen or ())]
        demand(observed["names"] == [str(s) for s in seen], "what is observed has other names")
        first, other = (words.include(read_tape(tape)) for tape in (observed, vars(made.function(seen))))
        demand_equal(words, first, other, "what is observed is something else")


def _check_scene(certificate: Any, data: Any) -> None:
    shock = Shock(**data["shock"]) if data["shock"] else None
    _check_generated(certificate, field_of(Scene(data["spins"], Rotor(**data["rotor"]), Link(**data["link"]), shock)))


def _check_structure(certificate: Any, data: Any) -> None:
    demand(
        3 * len(data["joints"]) <= len(certificate["motion"]["outputs"]),
        "the structure has more rotors than the program",
    )
    parts = {"rotor": Rotor, "link": Link, "braces": Brace}
    program, held = structure_program(
        Assembly(**data | {name: [kind(**x) for x in data[name]] for name, kind in parts.items()})
    )
    _check_generated(certificate, Field(program, {}, (), held=held))


def _check_rates(certificate: Any, data: Any) -> None:
    """Rates in words."""
    words = Words(certificate["motion"]["arguments"], None)
    demand(certificate.get("observed") is None, "what is observed has no meaning")
    rates = _rates(words, certificate)
    named = [words.place(text) for text in data]
    demand_equal(words, rates, named, "the rates are others")
    _values(words, named, _middle(certificate), certificate)


class LagrangianOfWords:
    """The certificate's program beside the words of a Lagrangian, of forces, friction and constraints."""

    def __init__(self, certificate: Any, data: Any) -> None:
        arguments, letters = certificate["motion"]["arguments"], data["letters"]
        demand(len({*arguments, *letters}) == len(arguments) + len(letters), "a letter has two meanings")
        demand(all(map(is_name, letters)), "a letter has no name")
        demand(certificate.get("observed") is None, "what is observed has no meaning")
        self.words = words = Words([*arguments, *letters], None)
        self.rates = _rates(words, certificate)
        self.n, self.timed = divmod(len(self.rates), 2)
        zero, one = (words.keep("number", x) for x in "01")
        self.q, self.v = [*range(self.n)], [*range(self.n, 2 * self.n)]
        clock = {words.names["t"]: one} if "t" in words.names else {}
        self.moving = clock | dict(enumerate(self.rates))
        self.swept = clock | dict(zip(self.q, self.v, strict=True))
        self.L, self.D = words.place(data["L"]), words.place(data["dissipation"])
        self.forces = [words.place(text) for text in data["forces"]] or [zero] * self.n
        held = [words.place(g) for g in data["constraints"]]
        residual = [words.slope(g, self.swept) for g in held]
        self.residual = residual + [words.place(f) for f in data["rolling"]]
        self.others = [arb(1)] * len(letters)  # whatever they are, the rates are the same
        self.autonomous = not clock and not self.residual and data["forces"] == []
        named = [*(f"{q}_dot" for q in arguments[: self.n]), *["t"] * self.timed]
        fits = arguments[self.n : len(self.rates)] == named and len(self.forces) == self.n
        demand(fits, "the states are not coordinates, their velocities and the time")
        own = words.below([*held, *self.residual]).isdisjoint(range(len(arguments), len(words.arguments)))
        demand(own, "a constraint has letters without a value")
        _check_start(certificate, words, [*held, *self.residual])
        self.certificate = certificate

    def by(self, place: int, letters: Sequence[int]) -> list[int]:
        """Derivatives of a result."""
        one = self.words.keep("number", "1")
        return [self.words.slope(place, {letter: one}) for letter in letters]

    def missing(self) -> list[int]:
        """d/dt ∂L/∂v − ∂L/∂q − Q + ∂D/∂v."""
        words, rows = self.words, []
        by_q, by_v, friction = self.by(self.L, self.q), self.by(self.L, self.v), self.by(self.D, self.v)
        for p, slope, Q, d in zip(by_v, by_q, self.forces, friction, strict=True):
            rate = words.keep("subtract", words.slope(p, self.moving), words.keep("add", slope, Q))
            rows.append(words.keep("add", rate, d))
        return rows

    def energy(self) -> int:
        """v·∂L/∂v − L."""
        words, total = self.words, self.words.keep("subtract", self.words.keep("number", "0"), self.L)
        for v, p in zip(self.v, self.by(self.L, self.v), strict=True):
            total = words.keep("add", total, words.keep("multiply", v, p))
        return total

    def check(self) -> None:
        """The rates satisfy the equations of motion, and keep the constraints."""
        words = self.words
        one, zero = words.keep("number", "1"), words.keep("number", "0")
        rows = [self.by(f, self.v) for f in self.residual]
        still = [words.slope(f, self.moving) for f in self.residual]
        clock = [one] * self.timed
        found, wanted = (
            [*self.rates[: self.n], *self.rates[2 * self.n :], *still],
            [*self.v, *clock, *[zero] * len(still)],
        )
        demand_equal(words, found, wanted, "the rates are not those of velocities under the constraints")
        n, k = self.n, len(rows)
        for values, p in residues(words, [*chain(*rows), *self.missing()]):
            own = fmpz_mod_mat(k + 1, n, values, fmpz_mod_ctx(p)).rank() == k
            demand(own, "the rates do not satisfy Lagrange's equations")
        slopes = [self.by(p, self.v) for p in self.by(self.L, self.v)]
        whole = [M + [row[i] for row in rows] for i, M in enumerate(slopes)]
        whole += [row + [zero] * k for row in rows]
        places = [*chain(*whole), self.L, self.D, *self.forces]
        found = _values(words, places, _middle(self.certificate), self.certificate)
        regular = (
            arb_mat(n + k, n + k, found[: (n + k) ** 2]).det() != 0
        )  # as a ball: letters modulo a prime may be dependent
        demand(regular, "the Lagrangian is not shown to give accelerations")


def second_derivatives(tape: Any, at: list[Ball], n: int) -> list[list[Ball]]:
    """Of a tape's output by its first n arguments, from its series along each of them and each two."""

    def along(*moved: int) -> Ball:
        rows = [Dual(Rest([x, arb(int(i in moved))], ZERO, 3)) for i, x in enumerate(at)]
        return term(evaluated(tape, rows)[0].value, 2)

    alone = [along(i) for i in range(n)]
    return [[2 * alone[i] if i == j else along(i, j) - alone[i] - alone[j] for j in range(n)] for i in range(n)]


_RULES: Mapping[str, Any] = {
    "scene": _check_scene,
    "structure": _check_structure,
    "rates": _check_rates,
    "Lagrangian": lambda certificate, data: LagrangianOfWords(certificate, data).check(),
}
