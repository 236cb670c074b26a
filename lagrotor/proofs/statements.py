"""The theorem of a certificate in words, composed from the claim that `check` verifies.

A certificate is plain data (JSON), which `check` verifies without the search. An exact number is text, mantissa in base 16 and
power of two: "3p-1" is 3/2. A ball is [midpoint, radius], a matrix a list of rows. `about` names the system; `motion` is the
tape x' = f(x) with its parameters; `start` has x_0 and w; `steps` has of each its length, terms and the set at its end; `claim`
has every number, kind and expression of the theorem.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from hashlib import sha256
from math import hypot
from typing import Any, Protocol

from lagrotor.proofs.balls import Ball, arb, of_text, precision, printed
from lagrotor.result_display import Shown

Certificate = dict[str, Any]
VERSION = 1


class Certified(Protocol):
    """A result with a certificate, either an attribute or computed when it is read."""

    @property
    def certificate(self) -> Certificate: ...


class Proved(Shown):
    """A result with a theorem, which its certificate has."""

    @property
    def theorem(self: Certified) -> str:
        """The theorem in words."""
        return theorem_of(self.certificate)


def theorem_of(certificate: Certificate) -> str:
    """The theorem in words."""
    with precision(int(certificate.get("bits", 64)) + 64):
        return _WORDS[certificate["kind"]](certificate)


def _claimed(data: Sequence[str]) -> Ball:
    """A ball [midpoint, radius]."""
    middle, wide = map(of_text, data)
    return middle + arb(0, wide.upper())


def _decimal(text: str) -> str:
    """A rational number as a decimal, where a short one is exact."""
    value = Fraction(text)
    if value.denominator == 1:
        return str(value)
    short = repr(float(value))
    return short if Fraction(short) == value else text


def _moment(data: Sequence[str]) -> str:
    """A time, as a decimal where its ball holds a short one."""
    x = _claimed(data)
    short = f"{float(x.mid()):.12g}"
    return short if x.contains(arb(short)) else printed(x, 15)


def _at_states(certificate: Certificate, states: Sequence[Any], sign: str, digits: int) -> str:
    """Each state with its ball."""
    names = certificate["motion"]["arguments"]
    return ", ".join(
        f"{name} {sign} {printed(_claimed(x), digits)}" for name, x in zip(names[: len(states)], states, strict=True)
    )


def _enclosure(certificate: Certificate) -> str:
    """Of the states at a time."""
    claim = certificate["claim"]
    states = _at_states(certificate, claim["states"], "in", 20)
    return f"At t = {printed(_claimed(claim['t']), 15)}: {states}.{_begin(certificate)}"


def _crossing(certificate: Certificate) -> str:
    """Of an expression that passes zero."""
    claim = certificate["claim"]
    passes = "first passes" if claim["first"] else "passes"
    event = certificate["event"]
    return (
        f"{event['of']} {passes} zero at a time t in {printed(_claimed(claim['time']), 15)} s.{_definitions([event])}"
        f"{_begin(certificate)}"
    )


def _no_crossing(certificate: Certificate) -> str:
    """Of an expression that keeps its sign."""
    event, end = certificate["event"], _moment(certificate["claim"]["time"])
    return f"{event['of']} does not pass zero from t = 0 to {end} s.{_definitions([event])}{_begin(certificate)}"


def _means(certificate: Certificate) -> str:
    """Of expressions over spans of time."""
    rows = [
        (x["of"], *map(_moment, (x["since"], x["until"])), _claimed(x["mean"])) for x in certificate["claim"]["means"]
    ]
    means = " ".join(f"The mean of {e} from t = {a} to {b} s is in {printed(x, 8)}." for e, a, b, x in rows)
    return means + _definitions(certificate["claim"]["means"]) + _begin(certificate)


def _begin(certificate: Certificate) -> str:
    """Of what this is, from which start, and with which parameters."""
    motion, start = certificate["motion"], certificate["start"]
    rows = [*zip(start["middle"], start["spread"], strict=True), *((x,) for x in motion["parameters"])]
    each = [
        (name, *map(sum, zip(*map(_exactly, row), strict=True)))
        for name, row in zip(motion["arguments"], rows, strict=True)
    ]
    size = len(motion["outputs"])
    rates = (list(motion["operations"][place]) for place in motion["outputs"])
    is_time = [row == ("t", 0, 0) and rate == ["number", "1"] for row, rate in zip(each, rates, strict=False)]
    states = [row for row, own in zip(each, is_time, strict=False) if not own]
    moved = [row for row in states if row[1:] != (0, 0)]
    few = len(states) - len(moved) > 2
    said = [_value(*row) for row in (moved if few else states)] + [f"all {'others' if moved else 'states'} 0"] * few
    given = _with([_value(*row) for row in each[size:]])
    return f" This is of {_subject(certificate)}, from t = 0 with {', '.join(said)}{given}."


def _with(parameters: Sequence[str]) -> str:
    return f", where {', '.join(parameters)}" if parameters else ""


def _of(certificate: Certificate) -> str:
    """Of what this is, with which parameters."""
    fixed = certificate["motion"]["parameters"]
    names = certificate["motion"]["arguments"][-len(fixed) :] if fixed else []
    given = [_value(name, *_exactly(x)) for name, x in zip(names, fixed, strict=True)]
    return f" This is of {_subject(certificate)}{_with(given)}."


def _subject(certificate: Certificate) -> str:
    """What has the certificate's program."""
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
    parts = [f"rotors at {joints} m of {_each([_rotors(x) for x in data['rotor']])}"]
    parts += [f"bars {', '.join(bars)}, each of {_each(links)}"] * bool(bars)
    parts += [f"spins {_row(data['spins'])} rad/s"]
    parts += [f"gravity {_number(data['gravity'])} m/s²"] * bool(data["gravity"])
    for name, unit in (("load", "kg"), ("friction", "N m s/rad"), ("spin_friction", "N m s/rad")):
        parts += [f"{name.replace('_', ' ')} {_row(data[name])} {unit}"] * any(data[name])
    parts += [
        f"a brace from {x['tip']} to {x['to']} of {_number(x['stiffness'])} N/m, {_number(x['damping'])} N s/m"
        for x in data["braces"]
    ]
    return f"the structure of {'; '.join(parts)}"


def as_upright(data: Any, i: int, j: int, length: float) -> bool:
    """Whether a bar is, to rounding, as long as its tips are apart when all axes are upright: then it is so exactly."""
    (x, y), (a, b) = data["joints"][i], data["joints"][j]
    return length == hypot(hypot(x - a, y - b), data["rotor"][i]["length"] - data["rotor"][j]["length"])


def _bar(data: Any, i: int, j: int, length: float) -> str:
    places = [(*data["joints"][k], data["rotor"][k]["length"]) for k in (i, j)]
    (*ends, own) = ([Fraction(repr(float(x))) for x in row] for row in (*places, [length]))
    exactly = sum((x - y) ** 2 for x, y in zip(*ends, strict=True)) == own[0] ** 2
    return (
        f"of {_number(length)} m"
        if exactly or not as_upright(data, i, j, length)
        else "as long as its tips are apart upright"
    )


def _each(said: Sequence[str]) -> str:
    """What all are, once where they are alike."""
    return said[0] if len({*said}) == 1 else "; ".join(said)


def _lagrangian(_: Certificate, data: Any) -> str:
    said = [f"the system with L = {data['L']}"]
    said += [f"dissipation {data['dissipation']}"] * (data["dissipation"] != "0")
    said += [f"forces ({', '.join(data['forces'])})"] * bool(data["forces"])
    said += [f"{g} = 0" for g in (*data["constraints"], *data["rolling"])]
    said += [f"whatever {', '.join(data['letters'])}"] * bool(data["letters"])
    return ", ".join(said)


def _rates(certificate: Certificate, data: Any) -> str:
    said = zip(certificate["motion"]["arguments"], data, strict=False)
    return f"the motion {', '.join(f'{name}′ = {rate}' for name, rate in said)}"


def _exactly(data: Sequence[str]) -> tuple[Fraction, ...]:
    """Midpoint and radius, unrounded."""
    return tuple(int(m, 16) * Fraction(2) ** int(e) for m, _, e in (text.partition("p") for text in data))


def _value(name: str, middle: Fraction, wide: Fraction) -> str:
    """A number of which the theorem is: a decimal that its narrow ball holds, else an interval within the ball."""
    digits, low, high = 3, Decimal(1), Decimal(0)
    while low > high:
        digits *= 2
        low, high = (
            Context(prec=digits, rounding=way).divide(Decimal(end.numerator), Decimal(end.denominator))
            for end, way in ((middle - wide, ROUND_CEILING), (middle + wide, ROUND_FLOOR))
        )
    first, last = map(_plain, (low, high))
    return f"{name} = {first}" if wide <= abs(middle) / 2**36 else f"{name} in [{first}, {last}]"


def _plain(x: Decimal) -> str:
    """A decimal, with a power of ten where it is small."""
    whole = f"{x:f}" if x == 0 or abs(x) > 1e-6 else str(x.normalize()).replace("E", "e")
    return whole.rstrip("0").rstrip(".") if "." in whole and "e" not in whole else whole


def _definitions(named: Sequence[Mapping[str, Any]]) -> str:
    """What the names of expressions mean, each once."""
    return "".join(dict.fromkeys(f" {each['of']} = {each['means']}." for each in named if "means" in each))


def _periodic_orbit(certificate: Certificate) -> str:
    """Of a periodic orbit; of the pair's precession with its amplitude."""
    claim = certificate["claim"]
    if "r0" in claim:
        return _precession(certificate)
    period = _claimed(claim["period"])
    known = (
        ""
        if not certificate["reversals"][0] or _keeps_energy(certificate)
        else _ones(certificate["ones"], claim["kind"])
    )
    return (
        f"There is a periodic orbit of period {printed(period, 25)} s, frequency {printed(2 * arb.pi() / period, 25)} rad/s, "
        f"from {_at_states(certificate, claim['start'], '=', 20)}; it is {claim['kind']}.{known}{_of(certificate)}"
    )


def _keeps_energy(certificate: Certificate) -> bool:
    """Whether two multipliers are 1 because the Lagrangian that is named has no time, and nothing else acts."""
    about = certificate["about"] or {}
    data = about.get("Lagrangian")
    if certificate["ones"] != 2 or data is None or "t" in data["letters"]:
        return False
    return data["dissipation"] == "0" and not (data["forces"] or data["constraints"] or data["rolling"])


def _ones(ones: int, kind: str) -> str:
    """What a kind takes of the system: that its integrals leave a pair of multipliers beside ones."""
    taken = ones and kind in ("elliptic", "hyperbolic", "parabolic")
    return f" That {ones} of its multipliers are 1 is known of the system." if taken else ""


def _precession(certificate: Certificate) -> str:
    """Return the words of the pair's orbit of one amplitude."""
    claim = certificate["claim"]
    stable = f", {claim['kind']}" if claim["kind"] != "undecided" else ""
    frequency = printed(2 * arb.pi() / _claimed(claim["period"]), 22)
    who = _subject(certificate)
    return (
        f"{who[0].upper()}{who[1:]} has, at r0 = {_decimal(claim['r0'][0])}, a paired precession{stable}; "
        f"it turns at {frequency} rad/s.{_ones(4, claim['kind'])}"
    )


def _equilibrium(certificate: Certificate) -> str:
    """Of an equilibrium, with what its stability takes of the system."""
    claim = certificate["claim"]
    given = {
        "stable": f" Its energy {certificate['energy']} is definite there and conserved.",
        "stable to first order": " It is conservative.",
    }.get(claim["stability"], "")
    at = _at_states(certificate, claim["q"], "=", 25)
    return f"There is an equilibrium at {at}; it is {claim['stability']}.{given}{_of(certificate)}"


def quantities(certificate: Certificate) -> dict[str, Ball]:
    """The numbers that are claimed, by name: states, means of expressions, `time`, `period`, `frequency` (rad/s)."""
    claim = certificate["claim"]
    with precision(int(certificate.get("bits", 64)) + 64):
        if "period" in claim:
            period = _claimed(claim["period"])
            return {"period": period, "frequency": 2 * arb.pi() / period}
        if "means" in claim:
            return {row["of"]: _claimed(row["mean"]) for row in claim["means"]}
        if certificate["kind"] == "crossing":
            return {"time": _claimed(claim["time"])}
        states = claim.get("states", claim.get("q", ()))
        return dict(zip(certificate["motion"]["arguments"], map(_claimed, states), strict=False))


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
