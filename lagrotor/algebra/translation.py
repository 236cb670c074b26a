"""Translation of an expression into the class of `identity`: other functions become symbols, their identities relations.

Each step is an identity for principal values in the region where it is applied:

    log(Π pᵢ**kᵢ) = Σ kᵢ log|pᵢ| of positive products,      a**b = exp(b log a),      exp(r log p) = p**r,
    cos θ = (1 − τ²)/(1 + τ²), sin θ = 2τ/(1 + τ²) with τ = tan(θ/2),      exp(u + iv) = exp(u) (cos v + i sin v),

and the recurrences of inverse functions, Γ and Bessel functions.  Equal arguments have one symbol.  A rule that needs an
unknown sign is not applied; the sign is noted in `missing`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from math import lcm
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from lagrotor.algebra.enclosures import jet_of
from lagrotor.algebra.reduction import vanishes
from lagrotor.algebra.scalar import degree, node_count
from lagrotor.algebra.signs import NONNEGATIVE, POSITIVE, Region, is_nonnegative, is_positive, is_real, signs
from lagrotor.algebra.special_functions import RULES
from lagrotor.errors import NotExactError, TooLargeError

# Bounds of a polynomial that is factored; nodes of an expression that is brought over one denominator for this.
_MOST_TERMS, _MOST_DEGREE, _MOST_PARTS = 40, 12, 300
_MOST_MULTIPLE = 24
_MOST_SAME = 12  # latest symbols of one function with which arguments are compared
_INDEX, _VARIABLE = sp.Dummy("i", integer=True), sp.Dummy("x", real=True)
_HYPERBOLIC: dict[Any, Callable[[Any], Any]] = {
    sp.sinh: lambda w: (w - 1 / w) / 2, sp.cosh: lambda w: (w + 1 / w) / 2,
    sp.tanh: lambda w: (w**2 - 1) / (w**2 + 1), sp.coth: lambda w: (w**2 + 1) / (w**2 - 1),
    sp.sech: lambda w: 2 * w / (w**2 + 1), sp.csch: lambda w: 2 * w / (w**2 - 1),
}  # fmt: skip
_CIRCULAR: dict[Any, Callable[[Any, Any], Any]] = {
    sp.sin: lambda c, s: s, sp.cos: lambda c, s: c, sp.tan: lambda c, s: s / c, sp.cot: lambda c, s: c / s,
    sp.sec: lambda c, s: 1 / c, sp.csc: lambda c, s: 1 / s,
}  # fmt: skip
_BY_OTHERS: dict[Any, Callable[[sp.Expr], sp.Expr]] = {
    sp.acot: lambda u: sp.atan(1 / u),
    sp.asec: lambda u: sp.pi / 2 - sp.asin(1 / u),
    sp.acsc: lambda u: sp.asin(1 / u),
    sp.acosh: lambda u: sp.log(u + sp.sqrt(u - 1) * sp.sqrt(u + 1)),
    sp.atanh: lambda u: sp.log(1 + u) / 2 - sp.log(1 - u) / 2,
}


def prove_zero(expression: sp.Expr, where: Region) -> tuple[tuple[sp.Expr, ...] | None, tuple[sp.Basic, ...]]:
    """Try to prove that an expression is zero, and return (divisors, missing).

    `divisors` must not vanish; it is None if the proof fails. `missing` lists inequalities that a rule of the translation would
    have needed.
    """
    first = second = Translation(where)
    translated = first.of(expression)
    if first.revised:
        second = Translation(where, first.steps, first.degrees)
        translated = second.of(expression)
    ring, zero = vanishes(translated, second.relations, second.numbers)
    divided = (second.restore(ring.expression(d) if n is None else n) for d, n in ring.divisors.items())
    divisors = tuple(dict.fromkeys((*divided, *second.signed)))
    missing = tuple(dict.fromkeys((*first.missing, *second.missing)))
    return (divisors if zero else None), missing


class Translation:
    """The translation of expressions in one region.

    `steps` are the denominators of angles, `degrees` those of roots. If an entry was `revised` after its first use, a second pass
    must start with the final entries.
    """

    def __init__(
        self, where: Region, steps: Mapping[Any, int] | None = None, degrees: Mapping[sp.Expr, int] | None = None
    ) -> None:
        self.where = where
        self.steps: dict[Any, int] = dict(steps or {})
        self.degrees: dict[sp.Expr, int] = dict(degrees or {})
        self.revised = False
        self.symbols: dict[Any, list[tuple[tuple[sp.Expr, ...], sp.Symbol]]] = {}
        self.meaning: dict[sp.Symbol, sp.Expr] = {}
        self.relations: dict[sp.Symbol, tuple[int, sp.Expr]] = {}
        self.numbers: dict[sp.Symbol, sp.Expr] = {}
        self.arcs: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]] = {}  # symbol of an arc -> cosine, sine
        self.logarithms: dict[sp.Symbol, tuple[sp.Expr, bool]] = {}  # log|p| -> (p, True); log b -> (b, False)
        self.exponentials: dict[sp.Symbol, sp.Expr] = {}  # exp(u) -> u
        self.missing: list[sp.Basic] = []
        self.signed: dict[sp.Expr, None] = {}  # factors of u in sign(u) = u/|u|, which must not vanish
        self.known: dict[sp.Expr, sp.Expr] = {}

    def of(self, e: sp.Expr) -> sp.Expr:
        if e not in self.known:
            self.known[e] = self._sought(e)
        return self.known[e]

    def restore(self, translated: sp.Expr) -> sp.Expr:
        """Return a translated expression in the original symbols and functions."""
        while generated := translated.free_symbols & self.meaning.keys():
            translated = translated.xreplace({symbol: self.meaning[symbol] for symbol in generated})
        return translated

    def symbol(self, head: Any, arguments: tuple[sp.Expr, ...], meaning: sp.Expr) -> sp.Symbol:
        """Return the symbol for the function `meaning` of translated arguments; equal arguments have the same symbol."""
        group = self.symbols.setdefault(head, [])
        for others, symbol in group[-_MOST_SAME:]:
            if all(self._same(a, b) for a, b in zip(arguments, others, strict=True)):
                return symbol
        sign = signs(meaning, self.where)
        kind = {"positive": True} if sign == POSITIVE else {} if sign is None else {"real": True}
        symbol = sp.Dummy(str(head), **kind)
        group.append((arguments, symbol))
        self.meaning[symbol] = meaning
        return symbol

    def _same(self, a: sp.Expr, b: sp.Expr) -> bool:
        if a == b:
            return True
        if a.is_number and b.is_number and not (self.numbers.keys() & (a.free_symbols | b.free_symbols)):
            return False
        try:
            return vanishes(a - b, self.relations, self.numbers)[1]
        except NotExactError:
            return False

    def note_missing(self, strict: bool, *sides: sp.Expr) -> None:
        """Record in `missing` that a rule needs these sides to be positive (`strict`) or nonnegative."""
        for side in sides:
            if not side.has(sp.I) and side.is_real is not False:
                relation = sp.Gt(side, 0) if strict else sp.Ge(side, 0)
                self.missing += [relation] if isinstance(relation, sp.core.relational.Relational) else []

    # Nodes ------------------------------------------------------------------------------------------------

    def _sought(self, e: sp.Expr) -> sp.Expr:
        if e.is_Rational or e in (sp.pi, sp.I):
            return e
        if e.is_Float or (e.has(sp.nan, sp.zoo, sp.oo, -sp.oo) and not isinstance(e, sp.Integral | sp.Sum)):
            raise NotExactError(f"{e} is not exact or not finite.")
        if e.is_Symbol:
            if e.is_commutative and e.is_finite is not False:
                return self.symbol("whole", (e,), e) if e.is_integer else e
            raise NotExactError(f"{e} must commute and be finite.")
        if e is sp.E:
            return self.exponential(sp.S.One)
        if e.is_Add or e.is_Mul:
            return e.func(*map(self.of, self._unbarred(e) if e.is_Mul else e.args))
        if isinstance(e, sp.exp):
            return self.exponential(self.of(e.args[0]))
        if e.is_Pow:
            return self._power(e)
        if isinstance(e, sp.log) and len(e.args) == 1:
            return self._log(e)
        if e.func in _CIRCULAR:
            return _CIRCULAR[e.func](*self.circle(self.of(e.args[0])))
        if e.func in _HYPERBOLIC:
            return _HYPERBOLIC[e.func](self.exponential(self.of(e.args[0])))
        return self._function(e)

    def _unbarred(self, e: sp.Mul) -> tuple[sp.Expr, ...]:
        """Return the factors of a product, in which ± a b replaces |a| |b| if the sign of a b is known."""
        bars = [factor for factor in e.args if isinstance(factor, sp.Abs)]
        product = sp.Mul(*(factor.args[0] for factor in bars))
        product_signs = signs(product, self.where) if len(bars) > 1 else None
        for side, half in ((1, NONNEGATIVE), (-1, {-1, 0})):
            if product_signs is not None and product_signs <= half:
                return (*(factor for factor in e.args if factor not in bars), side * product)
        if product_signs is not None:
            self.note_missing(False, product)
        return e.args

    def _function(self, e: sp.Expr) -> sp.Expr:
        if isinstance(e, sp.asin | sp.acos | sp.atan):
            return self._arc(e)
        if isinstance(e, sp.asinh) and is_real(e.args[0], self.where):
            u = self.of(e.args[0])
            return self.log_size(u + self.root(u**2 + 1, sp.S.Half))
        if isinstance(e, sp.atan2) and is_positive(e.args[1], self.where):
            return self.of(sp.atan(e.args[0] / e.args[1], evaluate=False))
        if e.func in _BY_OTHERS:
            return self.of(_BY_OTHERS[e.func](e.args[0]))
        if isinstance(e, sp.Abs | sp.sign | sp.re | sp.im | sp.conjugate):
            return self._complex_part(e)
        if e.func in RULES and (rule := RULES[e.func](*e.args)) is not None and rule != e:
            return self.of(rule)
        if isinstance(e, sp.Integral | sp.Sum):
            return self._accumulated(e)
        if (jet := jet_of(e)) is not None:
            return self.symbol(jet[0], tuple(map(self.of, jet[1])), e)
        if isinstance(e, sp.Function | sp.NumberSymbol) and not isinstance(e, AppliedUndef):
            return self.symbol(e.func, tuple(map(self.of, e.args)), e)
        raise NotExactError(f"{e} is outside the class.")

    def _accumulated(self, e: sp.Expr) -> sp.Expr:
        """Translate an integral into a difference of antiderivatives, and a sum into a symbol for its body and limits."""
        body, (x, *ends), *others = e.args
        if others or not body.has(AppliedUndef):
            raise NotExactError(f"{e} is outside the class.")
        index = _INDEX if isinstance(e, sp.Sum) else _VARIABLE
        inside = self.of(body.xreplace({x: index}))
        if isinstance(e, sp.Sum):
            low, high = map(self.of, ends)
            return self.symbol("sum", (inside, low, high), e)
        values = [
            self.symbol("antiderivative", (inside, self.of(end)), sp.Integral(body, (x, end))) for end in (ends or [x])
        ]
        return values[1] - values[0] if len(values) == 2 else values[0]

    # Powers and exponentials -----------------------------------------------------------------------------------------

    def _power(self, e: sp.Expr) -> sp.Expr:
        base, exponent = e.base, e.exp
        if exponent.is_Integer:
            return self.of(base) ** exponent
        if exponent.is_Rational:
            if exponent.q == 2 and (side := _square_root(base)) is not None and is_real(side, self.where):
                return self.of(sp.Abs(side, evaluate=False)) ** exponent.p
            if e.is_number and (e.is_algebraic or base.is_algebraic):
                return self._number(sp.Pow(base, sp.Rational(1, exponent.q), evaluate=False)) ** exponent.p
            return self.root(self.of(base), exponent, base)
        base_signs = signs(base, self.where)
        if base_signs is not None and base_signs <= NONNEGATIVE:  # without 0**b, which is not in the domain
            return self.exponential(sp.expand(self.of(exponent) * self.log_size(self.of(base))))
        if exponent.is_integer:
            if base in (sp.S.NegativeOne, sp.I):
                return self._turned(e)
            if (angle := _angle_of_unit(base)) is not None:
                return self.exponential(sp.expand(sp.I * self.of(exponent * angle)))
            return self._whole_power(self.of(base), self.of(exponent))
        self.note_missing(True, base)
        return self.exponential(sp.expand(self.of(exponent) * self._complex_log(base)))

    def _turned(self, e: sp.Expr) -> sp.Expr:
        """Translate (−1)**n or i**n; terms of n that leave the power unchanged, multiples of 2 or of 4, are dropped."""
        period = 2 if e.base is sp.S.NegativeOne else 4
        terms = [term for term in sp.Add.make_args(sp.expand(e.exp)) if not (term / period).is_integer]
        power = e.base ** sp.Add(*terms)
        if not power.free_symbols:
            return self.of(power)
        sign = self.symbol(("unit", e.base), (self.of(sp.Add(*terms)),), power)
        self.relations.setdefault(sign, (period, sp.S.One))
        return sign

    def _whole_power(self, base: sp.Expr, n: sp.Expr) -> sp.Expr:
        """Return base**n for an integer n as Π pᵢ**(kᵢ n) over the factors pᵢ of the base, which may have any sign."""
        content, factors = self.factors(base)
        result = self.exponential(sp.expand(n * self.log_size(abs(content))))
        if content < 0:
            result *= self._turned(sp.Pow(sp.S.NegativeOne, self.restore(n), evaluate=False))
        for p, k in factors:
            log = self.log_size(p) if is_positive(self.restore(p), self.where) else self._log_symbol(p)
            result *= self.exponential(sp.expand(k * n * log))
        return result

    def root(self, base: sp.Expr, r: sp.Rational, meaning: sp.Expr | None = None) -> sp.Expr:
        """Return base**r of a translated base as a product of powers of its factors, as far as their signs are known."""
        original = self.restore(base) if meaning is None else meaning
        base_signs = signs(original, self.where)
        if base_signs is None or not base_signs <= NONNEGATIVE:
            if base_signs is not None:
                self.note_missing(False, original)
            whole = r.is_Integer or node_count(base) > _MOST_PARTS
            return self._principal(base, r, original) if whole else self._without_squares(base, r, original)
        content, factors = self.factors(base)
        if not self._are_real(factors):
            return self._principal(base, r, original)
        result = self._number_power(abs(content), r)
        for p, k in factors:
            result *= self._size_power(p, k * r)
        return result

    def _without_squares(self, base: sp.Expr, r: sp.Rational, meaning: sp.Expr) -> sp.Expr:
        """Return base**r for a base of any sign, after positive squares have been extracted.

        The rule is (a b)**r = a**r b**r for a square a > 0; only first powers remain in b.
        """
        content, factors = self.factors(base)
        result, remainder = self._number_power(abs(content), r), sp.sign(content)
        for p, k in factors:
            factor_signs = signs(self.restore(p), self.where)
            if factor_signs is None:
                remainder *= p**k
                continue
            odd = 0 if factor_signs <= NONNEGATIVE else k % 2
            if k != odd:
                result *= self._size_power(p, (k - odd) * r)
            remainder *= p**odd
        if result == 1:
            return self._principal(base, r, meaning)
        return result * self._principal(sp.expand(remainder), r, self.restore(remainder))

    def _size_power(self, p: sp.Expr, r: sp.Rational) -> sp.Expr:
        """Return |p|**r of a real p."""
        if p in self.exponentials:
            return self.exponential(self.exponentials[p] * r)
        original = self.restore(p)
        base_signs = signs(original, self.where)
        if base_signs is not None and base_signs <= NONNEGATIVE:
            return self._principal(p, r, original)
        if base_signs is not None and base_signs <= {-1, 0}:
            return self._principal(-p, r, -original)
        if base_signs is not None and r.is_Integer and r % 2 == 0:
            return p**r
        self.note_missing(False, original)
        size = self.symbol("size", (p,), sp.Abs(original))
        self.relations.setdefault(size, (2, p**2))
        return self._principal(size, r, sp.Abs(original))

    def _principal(self, base: sp.Expr, r: sp.Rational, meaning: sp.Expr) -> sp.Expr:
        """Return base**r as a power of a symbol for base**(1/q), where q is a common denominator of the exponents."""
        if r.is_Integer:
            return base**r
        if base.is_Rational:
            return self._number_power(base, r)
        key = self.restore(base)  # the symbols of two passes differ
        q = self._multiple_of(self.degrees, key, int(r.q))
        symbol = self.symbol(f"root{q}", (base,), sp.Pow(meaning, sp.Rational(1, q)))
        self.relations.setdefault(symbol, (q, base))
        return symbol ** int(r * q)

    def _multiple_of(self, denominators: dict[Any, int], key: Any, q: int) -> int:
        """Make the entry of `key` a multiple of q, and return it."""
        known = denominators.get(key, q)
        denominators[key] = lcm(known, q)
        self.revised = self.revised or denominators[key] != known
        return denominators[key]

    def _number_power(self, value: sp.Rational, r: sp.Rational) -> sp.Expr:
        return sp.Mul(*(f if f.is_Rational else self._number(f) for f in sp.Mul.make_args(sp.Pow(value, r))))

    def _number(self, e: sp.Expr) -> sp.Expr:
        """Return a symbol for an algebraic number; a rational number and i are returned unchanged."""
        if e.is_Rational or e is sp.I:
            return e
        symbol = self.symbol("number", (e,), e)
        self.numbers[symbol] = e
        return symbol

    def exponential(self, u: sp.Expr) -> sp.Expr:
        """Return exp(u) of a translated u as a product over the terms of u."""
        result = sp.S.One
        for rate, monomial in self.terms(u):
            if monomial.has(sp.I):
                c, s = self._pair(rate, sp.expand(monomial / sp.I))
                result *= c + sp.I * s
            elif monomial in self.logarithms:
                p, size = self.logarithms[monomial]
                result *= self._size_power(p, rate) if size else self._principal(p, rate, self.restore(p))
            else:
                key = "exp", self.restore(monomial)
                step = self._multiple_of(self.steps, key, int(rate.q))
                # Unevaluated: sympy would expand p**n from exp(n log p), which does not end for n = 10**8.
                w = self.symbol(key, (), sp.exp(self.restore(monomial) / step, evaluate=not key[1].has(sp.log)))
                self.exponentials[w] = monomial / step
                result *= w ** int(rate * step)
        return result

    def terms(self, u: sp.Expr) -> list[tuple[sp.Rational, sp.Expr]]:
        """Write u as Σ rate · product of symbols, and return the pairs (rate, product); a sum as divisor becomes one symbol."""
        over, under = sp.fraction(sp.together(u))
        over = sp.expand(over)
        under = sp.expand(under)
        if under.is_Add:
            content, under = under.primitive()
            if under.could_extract_minus_sign():
                content, under = -content, -under
            over, under = over / content, self.symbol("divisor", (under,), self.restore(under))
        terms = []
        for term in sp.Add.make_args(sp.expand(over / under)):
            rate, monomial = term.as_coeff_Mul()
            if not rate.is_Rational:
                raise NotExactError(f"{u} is no argument of a function in the class.")
            if rate:
                terms.append((rate, monomial))
        return terms

    # Angles ------------------------------------------------------------------------------------------------------------

    def circle(self, u: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Return cosine and sine of a translated u by the addition theorems for the terms of u."""
        total, terms = (sp.S.One, sp.S.Zero), self.terms(u)
        if any(term in self.arcs and rate.q % 2 == 0 for rate, term in terms) and (half := self._half(u)) is not None:
            return half
        for rate, monomial in terms:
            if monomial.has(sp.I):
                w = self.exponential(sp.expand(rate * monomial / sp.I))
                pair = (w + 1 / w) / 2, sp.I * (w - 1 / w) / 2
            else:
                pair = self._pair(rate, monomial)
            total = _sum(total, pair)
        return total

    def _half(self, u: sp.Expr) -> tuple[sp.Expr, sp.Expr] | None:
        """Return cos u = √((1 + cos 2u)/2) and sin u = sin 2u/(2 cos u) if cos u is known to be nonnegative, else None."""
        if not is_nonnegative(sp.cos(self.restore(u)), self.where):
            return None
        cosine, sine = self.circle(sp.expand(2 * u))
        half = self.root(sp.expand((1 + cosine) / 2), sp.S.Half, sp.cos(self.restore(u)) ** 2)
        return half, sine / (2 * half)

    def _pair(self, rate: sp.Rational, monomial: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        if monomial is sp.pi:
            return self._number_of_turn(sp.cos(rate * sp.pi)), self._number_of_turn(sp.sin(rate * sp.pi))
        angle = rate * monomial
        if not monomial.has(sp.I) and (angle / (2 * sp.pi)).is_integer is None and self._turns(angle):
            return sp.S.One, sp.S.Zero
        if monomial in self.arcs and rate.is_Integer:
            return _multiple(self.arcs[monomial], int(rate))
        key = "angle", self.restore(monomial)
        step = self._multiple_of(self.steps, key, int(rate.q))
        tau = self.symbol(key, (), sp.tan(self.restore(monomial) / (2 * step)))
        square = 1 + tau**2
        return _multiple(((1 - tau**2) / square, 2 * tau / square), int(rate * step))

    def _turns(self, angle: sp.Expr) -> bool:
        """Return True if an angle is an integer multiple of 2π for all values of its integer symbols."""
        return bool((self.restore(angle) / (2 * sp.pi)).is_integer)

    def _number_of_turn(self, value: sp.Expr) -> sp.Expr:
        if value.is_Rational:
            return value
        return sp.expand(value).replace(lambda n: n.is_Pow or isinstance(n, sp.sin | sp.cos), self._number)

    # Logarithms --------------------------------------------------------------------------------------------------------

    def _log(self, e: sp.Expr) -> sp.Expr:
        u = e.args[0]
        argument_signs = signs(u, self.where)
        if argument_signs is None:
            return self._complex_log(u)
        if argument_signs <= NONNEGATIVE:
            return self.log_size(self.of(u))
        if argument_signs <= {-1, 0}:
            return self.log_size(self.of(u)) + sp.I * sp.pi
        self.note_missing(True, u, *(self.restore(p) for p, _ in self.factors(self.of(u))[1]))
        return self._complex_log(u)

    def _complex_log(self, u: sp.Expr) -> sp.Expr:
        if isinstance(u, sp.exp):
            angle = sp.expand(u.args[0] / sp.I)
            if is_real(angle, self.where):
                if is_positive(angle + sp.pi, self.where) and is_nonnegative(sp.pi - angle, self.where):
                    return self.of(u.args[0])
                self.note_missing(True, angle + sp.pi)
                self.note_missing(False, sp.pi - angle)
        ratio = sp.expand(u / sp.I)
        if (ratio_signs := signs(ratio, self.where)) in (POSITIVE, frozenset({-1})):
            side = 1 if ratio_signs == POSITIVE else -1
            return self.log_size(self.of(side * ratio)) + side * sp.I * sp.pi / 2
        return self._log_symbol(self.of(u))

    def _log_symbol(self, b: sp.Expr) -> sp.Expr:
        symbol = self.symbol("log", (b,), sp.log(self.restore(b)))
        self.logarithms.setdefault(symbol, (b, False))
        return symbol

    def log_size(self, u: sp.Expr) -> sp.Expr:
        """Return log|u| of a real translated u as a sum over its factors."""
        content, factors = self.factors(u)
        if not self._are_real(factors):
            return self._size_symbol(u)
        total = sp.S.Zero
        content = sp.Abs(content)
        for side, sign in ((content.p, 1), (content.q, -1)):
            for prime, k in sp.factorint(side, limit=10**5).items():
                total += sign * k * self._size_symbol(sp.Integer(prime))
        for p, k in factors:
            total += k * self._log_of_factor(p)
        return total

    def _log_of_factor(self, p: sp.Expr) -> sp.Expr:
        if p in self.exponentials:
            return self.exponentials[p]
        if p in self.relations:
            q, value = self.relations[p]
            return (self._size_symbol(value) if value.is_Symbol else self.log_size(value)) / q
        number = self.numbers.get(p, p)
        if number is not p and number.is_Pow and number.exp.is_Rational and number.base.is_positive:
            return self.log_size(self.of(number.base)) * number.exp
        return self._size_symbol(p)

    def _size_symbol(self, p: sp.Expr) -> sp.Expr:
        symbol = self.symbol("logsize", (p,), sp.log(sp.Abs(self.restore(p))))
        self.logarithms.setdefault(symbol, (p, True))
        return symbol

    def _are_real(self, factors: list[tuple[sp.Expr, int]]) -> bool:
        """Return True if each factor is known to be real. A product can be real although its factors are not."""
        return all(is_real(self.restore(p), self.where) for p, _ in factors)

    def factors(self, u: sp.Expr) -> tuple[sp.Rational, list[tuple[sp.Expr, int]]]:
        """Write u as content · Π p**k with coprime p, whose leading coefficients are positive; return content and [(p, k)]."""
        if node_count(u) > _MOST_PARTS:
            raise TooLargeError(f"An argument of a root or a logarithm has more than {_MOST_PARTS} parts.")
        over, under = sp.fraction(sp.together(u))
        content, exponents = sp.S.One, dict[sp.Expr, int]()
        for side, sign in ((over, 1), (under, -1)):
            factorization = self._polynomial(side)
            c, factors = factorization if factorization is not None else (sp.S.One, [(side, 1)])
            content *= c**sign
            for p, k in factors:
                exponents[p] = exponents.get(p, 0) + sign * k
        return content, [(p, k) for p, k in exponents.items() if k]

    def _polynomial(self, side: sp.Expr) -> tuple[sp.Rational, list[tuple[sp.Expr, int]]] | None:
        replacements = {value: symbol**q for symbol, (q, value) in self.relations.items() if value.is_Symbol}
        side = side.xreplace(replacements)
        if side.has(sp.I) or degree(side) > _MOST_DEGREE:
            return None
        side = self._without_powers(sp.expand(side))
        if side.is_Rational:
            return side, []
        if len(sp.Add.make_args(side)) > _MOST_TERMS:
            return None
        try:
            content, factors = sp.factor_list(side)
        except (sp.PolynomialError, NotImplementedError):
            return None
        if not content.is_Rational:
            factors, content = [*factors, (content, 1)], sp.S.One
        return content, [(sp.expand(p), int(k)) for p, k in factors]

    def _without_powers(self, side: sp.Expr) -> sp.Expr:
        """Reduce high powers of symbols by the polynomial relations of these symbols."""
        for symbol, (q, value) in reversed(self.relations.items()):
            if side.has(symbol) and value.is_polynomial() and not value.is_Symbol:
                side = sp.rem(side, symbol**q - value, symbol)
        return side

    # Arcs and complex parts ----------------------------------------------------------------------------------------------------

    def _arc(self, e: sp.Expr) -> sp.Expr:
        u = e.args[0]
        inner, low, high = {
            sp.asin: (sp.sin, -sp.pi / 2, sp.pi / 2),
            sp.acos: (sp.cos, sp.S.Zero, sp.pi),
            sp.atan: (sp.tan, -sp.pi / 2, sp.pi / 2),
        }[e.func]
        if isinstance(u, inner):
            v = u.args[0]
            if is_nonnegative(v - low, self.where) and is_nonnegative(high - v, self.where):
                return self.of(v)
            self.note_missing(False, v - low, high - v)
        if isinstance(e, sp.acos):
            return sp.pi / 2 - self.of(sp.asin(u))
        t = self.of(u)
        if t.could_extract_minus_sign():
            return -self.of(e.func(-u)) if e.func(-u).func is e.func else self._arc_symbol(e, t)
        return self._arc_symbol(e, t)

    def _arc_symbol(self, e: sp.Expr, t: sp.Expr) -> sp.Symbol:
        u = e.args[0]
        symbol = self.symbol(e.func, (t,), e)
        if symbol not in self.arcs:
            side = 1 if isinstance(e, sp.atan) else -1
            square = 1 + side * u**2
            if u.is_number and u.is_algebraic:  # its square root may be simpler
                root = self.of(sp.sqrt(sp.expand(square)))
            else:
                root = self.root(1 + side * t**2, sp.S.Half, square)
            self.arcs[symbol] = (1 / root, t / root) if isinstance(e, sp.atan) else (root, t)
        return symbol

    def _complex_part(self, e: sp.Expr) -> sp.Expr:
        """Translate |u|, sign u, re u, im u or the conjugate of u."""
        u = e.args[0]
        t = self.of(u)
        if is_real(u, self.where):
            if isinstance(e, sp.re | sp.conjugate):
                return t
            if isinstance(e, sp.im):
                return sp.S.Zero
            if isinstance(e, sp.sign):
                bases = (factor.as_base_exp()[0] for factor in sp.Mul.make_args(sp.factor(u)))
                self.signed |= dict.fromkeys(f for f in bases if 0 in (signs(f, self.where) or {0}))
            if is_nonnegative(u, self.where):
                size = t
            else:
                size = self.root(t**2, sp.S.Half, u**2)
                self.note_missing(False, u)
            return size if isinstance(e, sp.Abs) else t / size
        if not all(is_real(self.restore(s), self.where) for s in t.free_symbols):
            return self.symbol(e.func, (t,), e)
        over, under = sp.fraction(sp.together(t))
        if under.has(sp.I):
            conjugate = under.xreplace({sp.I: -sp.I})
            over, under = sp.expand(over * conjugate), sp.expand(under * conjugate)
        over = sp.expand(over)
        i = sp.Dummy()
        real, imaginary = (
            sp.Add(*(c for (n,), c in sp.Poly(over.xreplace({sp.I: i}), i).terms() if n % 2 == parity))
            for parity in (0, 1)
        )
        real, imaginary = real / under, imaginary / under
        if isinstance(e, sp.re):
            return real
        if isinstance(e, sp.im):
            return imaginary
        if isinstance(e, sp.conjugate):
            return real - sp.I * imaginary
        square = sp.together(real**2 + imaginary**2)
        content, factors = self.factors(square)
        size = self._number_power(abs(content), sp.S.Half)
        for p, k in factors:
            size *= self._size_power(p, sp.Rational(k, 2))
        return size if isinstance(e, sp.Abs) else t / size


def _angle_of_unit(base: sp.Expr) -> sp.Expr | None:
    """Return u if base = cos u ± i sin u; None otherwise."""
    for cosine in base.atoms(sp.cos):
        u = cosine.args[0]
        for side in (1, -1):
            if base == cosine + side * sp.I * sp.sin(u):
                return side * u
    return None


def _square_root(base: sp.Expr) -> sp.Expr | None:
    """Return v if base = v² is a product of even powers; None otherwise."""
    number, factors = base.as_coeff_mul()
    powers = [factor.as_base_exp() for factor in factors]
    if not base.free_symbols or not number.is_positive or not all(k.is_Integer and k.is_even for _, k in powers):
        return None
    return sp.Mul(*(b ** (k / 2) for b, k in powers))


def _sum(a: tuple[sp.Expr, sp.Expr], b: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """Return cosine and sine of the sum of two angles, each given by its cosine and sine."""
    return a[0] * b[0] - a[1] * b[1], a[1] * b[0] + a[0] * b[1]


def _multiple(pair: tuple[sp.Expr, sp.Expr], n: int) -> tuple[sp.Expr, sp.Expr]:
    """Return cosine and sine of n times an angle, given by its cosine and sine."""
    if abs(n) > _MOST_MULTIPLE:
        raise NotExactError(f"A multiple {n} of an angle is too large.")
    total = reduce(lambda a, _: _sum(a, pair), range(abs(n)), (sp.S.One, sp.S.Zero))
    return total if n >= 0 else (total[0], -total[1])
