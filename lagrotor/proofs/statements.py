"""The theorem of a certificate in words, composed from the claim that `check` verifies.

A certificate is plain data (JSON). An exact number is text, mantissa in base 16 and power of two: "3p-1" is 3/2. A ball is
[midpoint, radius], a matrix a list of rows. `about` names the system; `motion` is the tape x' = f(x) with its parameters;
`start` has x_0 and w; each row of `steps` has its length, terms and end node; `claim` has the numbers and kinds of the
theorem.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from hashlib import sha256
from math import hypot
from typing import Any, Protocol

from lagrotor.proofs.balls import Ball, arb, format_ball, of_text, precision
from lagrotor.result_display import Shown

Certificate = dict[str, Any]
VERSION = 1


class Certified(Protocol):
    """A result that has a `certificate`, either as an attribute or as a property that computes it."""

    @property
    def certificate(self) -> Certificate: ...


class Proved(Shown):
    """A result whose certificate states a theorem."""

    @property
    def theorem(self: Certified) -> str:
        """The theorem in words."""
        return theorem_of(self.certificate)


def theorem_of(certificate: Certificate) -> str:
    with precision(int(certificate.get("bits", 64)) + 64):
        return _WORDS[certificate["kind"]](certificate)


def _read_ball(data: Sequence[str]) -> Ball:
    middle, wide = map(of_text, data)
    return middle + arb(0, wide.upper())


def _decimal(text: str) -> str:
    """Return a rational number as a decimal if a short one is exact."""
    value = Fraction(text)
    if value.denominator == 1:
        return str(value)
    short = repr(float(value))
    return short if Fraction(short) == value else text


def _time(data: Sequence[str]) -> str:
    """Return a time as text: a short decimal if the ball contains one, else the ball."""
    x = _read_ball(data)
    short = f"{float(x.mid()):.12g}"
    return short if x.contains(arb(short)) else format_ball(x, 15)


def _at_states(certificate: Certificate, states: Sequence[Any], sign: str, digits: int) -> str:
    names = certificate["motion"]["arguments"]
    rows = zip(names[: len(states)], map(_read_ball, states), strict=True)
    return ", ".join(f"{name} {sign} {format_ball(x, digits)}" for name, x in rows)


def _enclosure(certificate: Certificate) -> str:
    claim = certificate["claim"]
    states = _at_states(certificate, claim["states"], "in", 20)
    return f"At t = {format_ball(_read_ball(claim['t']), 15)}: {states}.{_start_phrase(certificate)}"


def _crossing(certificate: Certificate) -> str:
    claim = certificate["claim"]
    passes = "first passes" if claim["first"] else "passes"
    event = certificate["event"]
    time = format_ball(_read_ball(claim["time"]), 15)
    return f"{event['of']} {passes} zero at a time t in {time} s.{_definitions([event])}{_start_phrase(certificate)}"


def _no_crossing(certificate: Certificate) -> str:
    event, end = certificate["event"], _time(certificate["claim"]["time"])
    return f"{event['of']} does not pass zero from t = 0 to {end} s.{_definitions([event])}{_start_phrase(certificate)}"


def _means(certificate: Certificate) -> str:
    claims = certificate["claim"]["means"]
    rows = [(x["of"], _time(x["since"]), _time(x["until"]), _read_ball(x["mean"])) for x in claims]
    means = " ".join(f"The mean of {e} from t = {a} to {b} s is in {format_ball(x, 8)}." for e, a, b, x in rows)
    return means + _definitions(certificate["claim"]["means"]) + _start_phrase(certificate)


def _start_phrase(certificate: Certificate) -> str:
    """Return the sentence about the subject, the initial state and the parameters of a theorem."""
    motion, start = certificate["motion"], certificate["start"]
    rows = [*zip(start["middle"], start["spread"], strict=True), *((x,) for x in motion["parameters"])]
    sums = [map(sum, zip(*map(_read_fractions, row), strict=True)) for row in rows]
    values = [(name, *numbers) for name, numbers in zip(motion["arguments"], sums, strict=True)]
    size = len(motion["outputs"])
    rates = (list(motion["operations"][place]) for place in motion["outputs"])
    is_time = [row == ("t", 0, 0) and rate == ["number", "1"] for row, rate in zip(values, rates, strict=False)]
    states = [row for row, clock in zip(values, is_time, strict=False) if not clock]
    nonzero = [row for row in states if row[1:] != (0, 0)]
    few = len(states) - len(nonzero) > 2
    phrases = [_value_phrase(*row) for row in (nonzero if few else states)]
    phrases += [f"all {'others' if nonzero else 'states'} 0"] * few
    parameters = _where_phrase([_value_phrase(*row) for row in values[size:]])
    return f" This holds for {_subject(certificate)}, from t = 0 with {', '.join(phrases)}{parameters}."


def _where_phrase(parameters: Sequence[str]) -> str:
    return f", where {', '.join(parameters)}" if parameters else ""


def _subject_phrase(certificate: Certificate) -> str:
    fixed = certificate["motion"]["parameters"]
    names = certificate["motion"]["arguments"][-len(fixed) :] if fixed else []
    parameters = [_value_phrase(name, *_read_fractions(x)) for name, x in zip(names, fixed, strict=True)]
    return f" This holds for {_subject(certificate)}{_where_phrase(parameters)}."


def _subject(certificate: Certificate) -> str:
    """Return the system that the certificate is about, or the digest of its program."""
    about = certificate["about"]
    if about is None:
        tape = [certificate["motion"][name] for name in ("arguments", "operations", "outputs")]
        return f"the motion whose program has the SHA-256 digest {sha256(json.dumps(tape).encode()).hexdigest()}"
    ((kind, data),) = about.items()
    return str(_SUBJECTS[kind](certificate, data))


def _number(x: float) -> str:
    return repr(float(x)).removesuffix(".0")


def _row(values: Sequence[float]) -> str:
    return ", ".join(map(_number, values))


def _rotors(x: Mapping[str, float]) -> str:
    return f"{_number(x['length'])} m, {_number(x['mass'])} kg, I1 = {_number(x['I1'])}, I3 = {_number(x['I3'])} kg m²"


def _scene(_: Certificate, data: Any) -> str:
    bar, shock = data["link"], data["shock"]
    sizes = f"{_number(bar['length'])} m, {_number(bar['mass'])} kg, {_number(bar['inertia'])} kg m²"
    pushed = ""
    if shock:
        since, width = (_number(shock[name]) for name in ("at", "width"))
        pushed = f", pushed at rotor {shock['body']} by ({_row(shock['force'])}) N exp(−((t − {since})/{width})²)"
    return f"the pair of spins {_row(data['spins'])} rad/s with a bar of {sizes} and rotors of {_rotors(data['rotor'])}{pushed}"


def _structure(_: Certificate, data: Any) -> str:
    joints = ", ".join(f"({_row(joint)})" for joint in data["joints"])
    bars = [f"{i}–{j} {_bar(data, i, j, length)}" for i, j, length in data["bars"]]
    links = [f"{_number(x['mass'])} kg, {_number(x['inertia'])} kg m²" for x in data["link"]]
    phrases = [f"rotors at {joints} m of {_common([_rotors(x) for x in data['rotor']])}"]
    phrases += [f"bars {', '.join(bars)}, each of {_common(links)}"] * bool(bars)
    phrases += [f"spins {_row(data['spins'])} rad/s"]
    phrases += [f"gravity {_number(data['gravity'])} m/s²"] * bool(data["gravity"])
    for name, unit in (("load", "kg"), ("friction", "N m s/rad"), ("spin_friction", "N m s/rad")):
        phrases += [f"{name.replace('_', ' ')} {_row(data[name])} {unit}"] * any(data[name])
    for x in data["braces"]:
        sizes = f"{_number(x['stiffness'])} N/m, {_number(x['damping'])} N s/m"
        phrases.append(f"a brace from {x['tip']} to {x['to']} of {sizes}")
    return f"the structure of {'; '.join(phrases)}"


def has_upright_size(data: Any, i: int, j: int, length: float) -> bool:
    """Return True if a bar has the rounded distance of its tips when all axes are upright; then the exact distance is meant."""
    (x, y), (a, b) = data["joints"][i], data["joints"][j]
    return length == hypot(hypot(x - a, y - b), data["rotor"][i]["length"] - data["rotor"][j]["length"])


def _bar(data: Any, i: int, j: int, length: float) -> str:
    places = [(*data["joints"][k], data["rotor"][k]["length"]) for k in (i, j)]
    (*ends, exact_length) = ([Fraction(repr(float(x))) for x in row] for row in (*places, [length]))
    exactly = sum((x - y) ** 2 for x, y in zip(*ends, strict=True)) == exact_length[0] ** 2
    upright = has_upright_size(data, i, j, length) and not exactly
    return "as long as its tips are apart upright" if upright else f"of {_number(length)} m"


def _common(phrases: Sequence[str]) -> str:
    return phrases[0] if len({*phrases}) == 1 else "; ".join(phrases)


def _lagrangian(_: Certificate, data: Any) -> str:
    phrases = [f"the system with L = {data['L']}"]
    phrases += [f"dissipation {data['dissipation']}"] * (data["dissipation"] != "0")
    phrases += [f"forces ({', '.join(data['forces'])})"] * bool(data["forces"])
    phrases += [f"{g} = 0" for g in (*data["constraints"], *data["rolling"])]
    phrases += [f"whatever {', '.join(data['letters'])}"] * bool(data["letters"])
    return ", ".join(phrases)


def _rates(certificate: Certificate, data: Any) -> str:
    rows = zip(certificate["motion"]["arguments"], data, strict=False)
    return f"the motion {', '.join(f'{name}′ = {rate}' for name, rate in rows)}"


def _read_fractions(data: Sequence[str]) -> tuple[Fraction, ...]:
    """Return midpoint and radius as exact fractions."""
    return tuple(int(m, 16) * Fraction(2) ** int(e) for m, _, e in (text.partition("p") for text in data))


def _value_phrase(name: str, middle: Fraction, wide: Fraction) -> str:
    """Return "name = value" with a decimal that the narrow ball contains, else an interval within the ball."""
    digits, low, high = 3, Decimal(1), Decimal(0)
    while low > high:
        digits *= 2
        ends = (middle - wide, ROUND_CEILING), (middle + wide, ROUND_FLOOR)
        contexts = ((Context(prec=digits, rounding=way), end) for end, way in ends)
        low, high = (context.divide(Decimal(end.numerator), Decimal(end.denominator)) for context, end in contexts)
    first, last = map(_plain, (low, high))
    return f"{name} = {first}" if wide <= abs(middle) / 2**36 else f"{name} in [{first}, {last}]"


def _plain(x: Decimal) -> str:
    """Return a decimal, with a power of ten if it is small."""
    whole = f"{x:f}" if x == 0 or abs(x) > 1e-6 else str(x.normalize()).replace("E", "e")
    return whole.rstrip("0").rstrip(".") if "." in whole and "e" not in whole else whole


def _definitions(named: Sequence[Mapping[str, Any]]) -> str:
    """Return one sentence for each named expression: its definition."""
    return "".join(dict.fromkeys(f" {row['of']} = {row['means']}." for row in named if "means" in row))


def _periodic_orbit(certificate: Certificate) -> str:
    claim = certificate["claim"]
    if "r0" in claim:
        return _precession(certificate)
    period = _read_ball(claim["period"])
    of_system = certificate["reversals"][0] and not _keeps_energy(certificate)
    premise = _ones_phrase(certificate["ones"], claim["kind"]) if of_system else ""
    length, frequency = format_ball(period, 25), format_ball(2 * arb.pi() / period, 25)
    start = _at_states(certificate, claim["start"], "=", 20)
    orbit = f"There is a periodic orbit of period {length} s, frequency {frequency} rad/s, from {start}; it is {claim['kind']}."
    return f"{orbit}{premise}{_subject_phrase(certificate)}"


def _keeps_energy(certificate: Certificate) -> bool:
    """Return True if two multipliers are 1 because energy is conserved: L has no time, and nothing else acts."""
    about = certificate["about"] or {}
    data = about.get("Lagrangian")
    if certificate["ones"] != 2 or data is None or "t" in data["letters"]:
        return False
    return data["dissipation"] == "0" and not (data["forces"] or data["constraints"] or data["rolling"])


def _ones_phrase(ones: int, kind: str) -> str:
    """Return the sentence that `ones` multipliers are 1 if the orbit's kind was proved with that knowledge; else ""."""
    needed = ones and kind in ("elliptic", "hyperbolic", "parabolic")
    return f" That {ones} of its multipliers are 1 is known of the system." if needed else ""


def _precession(certificate: Certificate) -> str:
    claim = certificate["claim"]
    stable = f", {claim['kind']}" if claim["kind"] != "undecided" else ""
    frequency = format_ball(2 * arb.pi() / _read_ball(claim["period"]), 22)
    who = _subject(certificate)
    orbit = f"has, at r0 = {_decimal(claim['r0'][0])}, a paired precession{stable}; it turns at {frequency} rad/s"
    return f"{who[0].upper()}{who[1:]} {orbit}.{_ones_phrase(4, claim['kind'])}"


def _equilibrium(certificate: Certificate) -> str:
    claim = certificate["claim"]
    premise = {
        "stable": f" Its energy {certificate['energy']} is definite there and conserved.",
        "stable to first order": " It is conservative.",
    }.get(claim["stability"], "")
    at = _at_states(certificate, claim["q"], "=", 25)
    return f"There is an equilibrium at {at}; it is {claim['stability']}.{premise}{_subject_phrase(certificate)}"


def quantities(certificate: Certificate) -> dict[str, Ball]:
    """Return the claimed numbers by name: states, means of expressions, `time`, `period`, `frequency` (rad/s)."""
    claim = certificate["claim"]
    with precision(int(certificate.get("bits", 64)) + 64):
        if "period" in claim:
            period = _read_ball(claim["period"])
            return {"period": period, "frequency": 2 * arb.pi() / period}
        if "means" in claim:
            return {row["of"]: _read_ball(row["mean"]) for row in claim["means"]}
        if certificate["kind"] == "crossing":
            return {"time": _read_ball(claim["time"])}
        states = claim.get("states", claim.get("q", ()))
        return dict(zip(certificate["motion"]["arguments"], map(_read_ball, states), strict=False))


_SUBJECTS: dict[str, Callable[[Certificate, Any], str]] = {
    "scene": _scene,
    "structure": _structure,
    "Lagrangian": _lagrangian,
    "rates": _rates,
}
_WORDS: dict[str, Callable[[Certificate], str]] = {
    "enclosure": _enclosure,
    "crossing": _crossing,
    "no crossing": _no_crossing,
    "means": _means,
    "periodic orbit": _periodic_orbit,
    "equilibrium": _equilibrium,
}
