"""The check of a theorem's subject: the program has the rates of the named scene, structure, Lagrangian or text.

The identities are decided modulo a prime, as in `reversals`. The checker generates the program of a scene or structure
again from its numbers. For a Lagrangian it forms Lagrange's equations, with d'Alembert's principle for constraints, from
the text.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

from flint import arb, arb_mat, fmpz_mod_ctx, fmpz_mod_mat

from lagrotor.pair.scene import Link, Rotor, Scene, Shock
from lagrotor.proofs.checker.bounded_series import Dual, Series, evaluate
from lagrotor.proofs.checker.certified_sets import balls, number, read_ball, term
from lagrotor.proofs.checker.expression_tapes import Words
from lagrotor.proofs.checker.reversals import points_of
from lagrotor.proofs.checker.tapes import ZERO, demand, is_name, read_tape
from lagrotor.proofs.fields import Field, field_of, structure_program
from lagrotor.structures.assembly import Assembly, Brace

Ball = Any


def check_subject(certificate: Any) -> None:
    """Verify that the program belongs to the named subject. If none is named, the digest of the program identifies it."""
    arguments, rates = certificate["motion"]["arguments"], certificate["motion"]["outputs"]
    if "t" in arguments:
        place, starts = arguments.index("t"), certificate.get("start", {}).get("middle", [])
        is_clock = place < len(rates) and certificate["motion"]["operations"][rates[place]] == ["number", "1"]
        demand(
            is_clock and place < len(starts) and read_ball(starts[place]).is_zero(),
            "the argument t is not the time, which starts at 0",
        )
        demand(
            read_ball(certificate["start"]["spread"][place]).is_zero(),
            "the argument t is not the time, which starts at 0",
        )
    about = certificate["about"]
    if about is None:
        demand(certificate.get("observed") is None, "there are observables, but the subject defines none")
        return
    demand(type(about) is dict and len(about) == 1, "the certificate does not name exactly one subject")
    (kind,) = about
    _RULES[kind](certificate, about[kind])


def _rates(words: Words, certificate: Any) -> list[int]:
    """Return the places of the states' rates in the certificate's program."""
    outputs = words.include(read_tape(certificate["motion"]))
    if certificate["kind"] == "periodic orbit":  # in units of a pace
        return [words.over(place, len(outputs)) for place in outputs]
    return outputs


def residues(words: Words, places: Sequence[int]) -> Iterator[tuple[list[int], int]]:
    """Yield the residues of results modulo a prime, and the prime, for each choice of the signs of the roots.

    A quantity counts as positive only if it must be positive in the program, along the motion. That the named subject needs it
    to be positive does not count.
    """
    for point in points_of(words.tape(places)):
        yield [x.value for x in point.outputs([])], point.p


def demand_equal(words: Words, first: Sequence[int], second: Sequence[int], what: str) -> None:
    """Verify that two lists of results are the same functions of the arguments, entry by entry."""
    demand(len(first) == len(second), what)
    for values, _ in residues(words, [*first, *second]):
        demand(values[: len(first)] == values[len(first) :], what)


def _check_start(certificate: Any, words: Words, constraints: Sequence[int]) -> None:
    """Verify that the start can satisfy the constraints. An orbit or equilibrium must not have any constraints."""
    if certificate["kind"] in ("periodic orbit", "equilibrium"):
        demand(len(constraints) == 0, "an equilibrium or orbit must not have constraints")
        return
    spread = balls(certificate["start"]["spread"])
    middle = _middle(certificate)
    residuals = _values(words, constraints, [x + y for x, y in zip(middle, spread, strict=True)], certificate)
    demand(all(x.contains(0) for x in residuals), "the start violates the constraints")


def _middle(certificate: Any) -> list[Ball]:
    """Return the middle of the initial set or of the equilibrium."""
    if certificate["kind"] == "equilibrium":
        at = [number(x) for x in certificate["middle"]]
        return [*at, *[ZERO] * len(at)]
    return balls(certificate["start"]["middle"])


def _values(words: Words, places: Sequence[int], at: Sequence[Ball], certificate: Any) -> list[Ball]:
    """Return the values of results at a start, with 1 for further symbols. Raises NotProved if a value is undefined."""
    numbers = [*at, *balls(certificate["motion"]["parameters"])]
    arguments = [*numbers, *[arb(1)] * (len(words.arguments) - len(numbers))]
    duals = [Dual(Series([x], ZERO, 1)) for x in arguments]
    values = [x.value.at_start() for x in evaluate(words.tape(places), duals)]
    demand(all(x.is_finite() for x in values), "the subject is undefined at the start")
    return values


def _check_generated(certificate: Any, field: Field) -> None:
    """Verify that program and observables equal those that are generated for the named scene or structure."""
    arguments, observed = certificate["motion"]["arguments"], certificate.get("observed")
    words = Words(arguments, None)
    rates, what = _rates(words, certificate), "the program is not the program of the subject"
    demand(arguments[: len(rates)] == [str(s) for s in field.states], what)
    demand_equal(words, rates, words.include(read_tape(vars(field.motion.tape))), what)
    constraints = words.include(read_tape(vars(field.function(field.constraints))))
    _check_start(certificate, words, constraints)
    if observed is not None:
        observables = [*(field.observables or ())]
        demand(
            observed["names"] == [str(s) for s in observables], "the observables do not have the names of the subject"
        )
        first, second = (words.include(read_tape(tape)) for tape in (observed, vars(field.function(observables))))
        demand_equal(words, first, second, "the observables are not the observables of the subject")


def _check_scene(certificate: Any, data: Any) -> None:
    shock = Shock(**data["shock"]) if data["shock"] else None
    _check_generated(certificate, field_of(Scene(data["spins"], Rotor(**data["rotor"]), Link(**data["link"]), shock)))


def _check_structure(certificate: Any, data: Any) -> None:
    fits = 3 * len(data["joints"]) <= len(certificate["motion"]["outputs"])
    demand(fits, "the structure has more rotors than the program")
    kinds = {"rotor": Rotor, "link": Link, "braces": Brace}
    rows = {name: [kind(**x) for x in data[name]] for name, kind in kinds.items()}
    program, constraints = structure_program(Assembly(**data | rows))
    _check_generated(certificate, Field(program, {}, (), constraints=constraints))


def _check_rates(certificate: Any, data: Any) -> None:
    words = Words(certificate["motion"]["arguments"], None)
    demand(certificate.get("observed") is None, "there are observables, but the subject defines none")
    rates = _rates(words, certificate)
    named = [words.place(text) for text in data]
    demand_equal(words, rates, named, "the rates are not those of the text")
    _values(words, named, _middle(certificate), certificate)


class LagrangianOfWords:
    """The program of a certificate, and the text of the Lagrangian, forces, dissipation and constraints."""

    def __init__(self, certificate: Any, data: Any) -> None:
        arguments, symbols = certificate["motion"]["arguments"], data["letters"]
        demand(len({*arguments, *symbols}) == len(arguments) + len(symbols), "a symbol has two meanings")
        demand(all(map(is_name, symbols)), "the name of a symbol is not one word")
        demand(certificate.get("observed") is None, "there are observables, but the subject defines none")
        self.words = words = Words([*arguments, *symbols], None)
        self.rates = _rates(words, certificate)
        self.n, self.timed = divmod(len(self.rates), 2)
        zero, unit = (words.keep("number", x) for x in "01")
        self.q, self.v = [*range(self.n)], [*range(self.n, 2 * self.n)]
        clock = {words.names["t"]: unit} if "t" in words.names else {}
        self.moving = clock | dict(enumerate(self.rates))
        self.swept = clock | dict(zip(self.q, self.v, strict=True))
        self.L, self.D = words.place(data["L"]), words.place(data["dissipation"])
        self.forces = [words.place(text) for text in data["forces"]] or [zero] * self.n
        constraints = [words.place(g) for g in data["constraints"]]
        residual = [words.slope(g, self.swept) for g in constraints]
        self.residual = residual + [words.place(f) for f in data["rolling"]]
        self.others = [arb(1)] * len(symbols)  # the rates do not depend on these symbols
        self.autonomous = not clock and not self.residual and data["forces"] == []
        named = [*(f"{q}_dot" for q in arguments[: self.n]), *["t"] * self.timed]
        fits = arguments[self.n : len(self.rates)] == named and len(self.forces) == self.n
        demand(fits, "the states are not coordinates, their velocities and the time")
        free = words.below([*constraints, *self.residual]).isdisjoint(range(len(arguments), len(words.arguments)))
        demand(free, "a constraint has symbols without a value")
        _check_start(certificate, words, [*constraints, *self.residual])
        self.certificate = certificate

    def by(self, place: int, symbols: Sequence[int]) -> list[int]:
        unit = self.words.keep("number", "1")
        return [self.words.slope(place, {symbol: unit}) for symbol in symbols]

    def missing(self) -> list[int]:
        """Return, for each coordinate, the place in `words` of d/dt ∂L/∂v − ∂L/∂q − Q + ∂D/∂v, which vanishes along a motion."""
        words, rows = self.words, []
        by_q, by_v, friction = self.by(self.L, self.q), self.by(self.L, self.v), self.by(self.D, self.v)
        for p, slope, Q, d in zip(by_v, by_q, self.forces, friction, strict=True):
            rate = words.keep("subtract", words.slope(p, self.moving), words.keep("add", slope, Q))
            rows.append(words.keep("add", rate, d))
        return rows

    def energy(self) -> int:
        """Return the index on the tape of the energy v·∂L/∂v − L."""
        words, total = self.words, self.words.keep("subtract", self.words.keep("number", "0"), self.L)
        for v, p in zip(self.v, self.by(self.L, self.v), strict=True):
            total = words.keep("add", total, words.keep("multiply", v, p))
        return total

    def check(self) -> None:
        """Verify that the rates satisfy the equations of motion and keep the constraints."""
        words = self.words
        unit, zero = words.keep("number", "1"), words.keep("number", "0")
        rows = [self.by(f, self.v) for f in self.residual]
        still = [words.slope(f, self.moving) for f in self.residual]
        clock = [unit] * self.timed
        results = [*self.rates[: self.n], *self.rates[2 * self.n :], *still]
        targets = [*self.v, *clock, *[zero] * len(still)]
        demand_equal(words, results, targets, "the rates are not those of velocities under the constraints")
        n, k = self.n, len(rows)
        for values, p in residues(words, [*chain(*rows), *self.missing()]):
            solvable = fmpz_mod_mat(k + 1, n, values, fmpz_mod_ctx(p)).rank() == k
            demand(solvable, "the rates do not satisfy Lagrange's equations")
        slopes = [self.by(p, self.v) for p in self.by(self.L, self.v)]
        whole = [M + [row[i] for row in rows] for i, M in enumerate(slopes)]
        whole += [row + [zero] * k for row in rows]
        places = [*chain(*whole), self.L, self.D, *self.forces]
        results = _values(words, places, _middle(self.certificate), self.certificate)
        # As a ball, since symbols can be dependent modulo a prime.
        regular = arb_mat(n + k, n + k, results[: (n + k) ** 2]).det() != 0
        demand(regular, "the Lagrangian is not proved to determine the accelerations")


def second_derivatives(tape: Any, at: list[Ball], n: int) -> list[list[Ball]]:
    """Return the second derivatives of an output with respect to n arguments, from series along each argument and pair."""

    def along(*directions: int) -> Ball:
        rows = [Dual(Series([x, arb(int(i in directions))], ZERO, 3)) for i, x in enumerate(at)]
        return term(evaluate(tape, rows)[0].value, 2)

    alone = [along(i) for i in range(n)]
    return [[2 * alone[i] if i == j else along(i, j) - alone[i] - alone[j] for j in range(n)] for i in range(n)]


_RULES: Mapping[str, Any] = {
    "scene": _check_scene,
    "structure": _check_structure,
    "rates": _check_rates,
    "Lagrangian": lambda certificate, data: LagrangianOfWords(certificate, data).check(),
}
