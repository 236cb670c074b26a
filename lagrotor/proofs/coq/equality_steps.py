"""The proof that two sides are equal, as steps that Coq checks.

Both sides are written in generators, and the numerator of their difference as a sum of cofactors times relations. A generator
is a symbol, the cosine and the sine of a base angle, an exponential, a root, or an uninterpreted function. The addition
theorems express every function in generators (`atom_n`). Every denominator is factored (`whole_n`), and each factor gets a
symbol (`factor_n`, `sum_n`). The two sides times a monomial then differ by a polynomial, the sum of q_i times relation_i. The
relations are sin^2 + cos^2 - 1, root^2 - radicand, and factor - polynomial. Division finds the q_i, since the leading terms of
the relations have no symbol in common; Coq checks them by `ring`. A premise with a symbol alone on one side is substituted. The
numerators of other premises, such as a^2 + b^2 = 1, are further relations (`ideal_n`), for which `cofactors` finds the q_i.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import lcm
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.polys.rings import PolyElement, PolyRing

from lagrotor.algebra.power_series import QUOTIENTS
from lagrotor.errors import NotExactError
from lagrotor.proofs.coq.cofactors import Fraction, SymbolEquation, cofactors_of, elimination, one_fraction
from lagrotor.proofs.coq.coq_terms import Comparison, Terms

_CIRCULAR, _EXPONENTIAL = (sp.sin, sp.cos), (sp.exp, sp.sinh, sp.cosh)
_OPAQUE = (sp.log, sp.atan, sp.asin, sp.acos)
_NOT_NEGATIVE = "first [assumption | lra | positive]"
# The largest multiple of a base angle; the largest number of terms of a denominator that is factored.
_LARGEST_MULTIPLE, _MOST_FACTORED = 12, 60


@dataclass(frozen=True)
class _Relation:
    """A polynomial in generators that is zero: its name in the proof, the polynomial, and its text."""

    name: str
    zero: sp.Expr
    text: str


class Sides:
    """The sides of a statement in generators, under equations between symbols; `steps` are the lines of the proof so far.

    equations: the premises premise_1, …; conditions: defined_1, …; small: the symbol of a series. Raises NotExactError for
    expressions outside the class.
    """

    def __init__(
        self,
        terms: Terms,
        expressions: Sequence[sp.Expr],
        equations: Sequence[SymbolEquation],
        conditions: Sequence[Comparison],
        small: sp.Symbol | None = None,
    ) -> None:
        self.terms, self.small = terms, small
        self.steps: list[str] = []
        self.eliminated, self.unsolved = elimination(equations)
        self.relations: list[_Relation] = []
        self.ideal: list[_Relation] = []
        self._values: dict[sp.Expr, sp.Expr] = {}
        self._generators: dict[Any, sp.Symbol] = {}
        self._rewritten: dict[str, list[tuple[int, str, bool]]] = {"whole": [], "atom": []}
        self._nonzero: set[sp.Symbol] = set()
        self._factors: dict[sp.Expr, sp.Symbol] = {}
        self._count: dict[str, int] = {}
        sides = [*expressions, *(e for _, e in conditions), *self.eliminated.values(), *self.unsolved.values()]
        self._quotients = sorted({f.func.__name__ for e in sides for f in e.atoms(sp.tan, sp.tanh)})
        self._step_of = _steps_of_angles(sides, self.eliminated)
        for place, (sign, e) in enumerate(conditions, 1):
            if sign == "<>":
                self._denominator(e, f"defined_{place}")
        for place in self.unsolved:
            self._premise(place, *equations[place - 1])

    def _premise(self, place: int, lhs: sp.Expr, rhs: sp.Expr) -> None:
        """Add the numerator of lhs − rhs, where premise number `place` is lhs = rhs, to the relations."""
        difference = self._fraction(self.value(lhs - rhs))
        zero, under = difference.numerator.as_expr(), difference.under
        name, text = self._name("ideal"), self.terms.write(zero)
        write, settled = self.terms.write, self._into_generators()
        tactics = f"apply (by_premise _ _ ({write(under)}) _ premise_{place}). {settled}same."
        self._assert(name, f"{text} = 0", tactics)
        self.ideal.append(_Relation(name, zero, text))

    def _assert(self, name: str, proposition: str, tactics: str) -> None:
        self.steps.append(f"assert ({name} : {proposition}). {{ {tactics} }}")

    def _name(self, kind: str) -> str:
        self._count[kind] = self._count.get(kind, 0) + 1
        return f"{kind}_{self._count[kind]}"

    @property
    def substitution(self) -> str:
        """The tactic that substitutes the premises in the goal."""
        return "".join(f"try subst {self.terms.names[symbol]}. " for symbol in self.eliminated)

    def _into_generators(self) -> str:
        """Return the tactics that write a goal in generators, the largest denominators and functions first.

        Terms of a substituted premise are rewritten after it; the value of a symbol is not, since the premise substitutes
        it.
        """
        steps = [(kind == "whole", *row) for kind, rows in self._rewritten.items() for row in rows]
        rows = sorted(steps, reverse=True)
        symbols = [name for _, _, name, symbol in rows if symbol]
        early, all_names = ([name for _, _, name, symbol in rows if not (symbol and late)] for late in (False, True))
        lists = (", ".join(f"?{name}" for name in names) for names in (early, all_names))
        first, second = (f"rewrite {names}. " if names else "" for names in lists)
        cleared = f"clear {' '.join(symbols)}. " if symbols else ""
        unfolded = "".join(f"try unfold {name}. " for name in self._quotients)
        return first + (unfolded + cleared + self.substitution + second if self.eliminated or unfolded else "")

    def value(self, node: sp.Expr) -> sp.Expr:
        """Return the expression in generators; its denominators are monomials."""
        if node not in self._values:
            self._values[node] = self._value(node)
        return self._values[node]

    def _value(self, node: sp.Expr) -> sp.Expr:
        if node.is_Symbol:
            return self.value(self.eliminated[node]) if node in self.eliminated else node
        if node.is_Rational:
            return node
        if node is sp.pi:
            return self._generator(sp.pi, "PI")
        if node.is_Mul and any(factor.is_Symbol and self.value(factor) == 0 for factor in node.args):
            return sp.S.Zero
        if node.is_Add or node.is_Mul:
            return node.func(*map(self.value, node.args))
        if node.is_Pow and node.base is not sp.E:
            return self._power(node)
        if node.func in QUOTIENTS:
            over, under = QUOTIENTS[node.func]
            above = sp.S.One if over is None else self.value(over(*node.args))
            return above / self._denominator(under(*node.args))
        return self._atom(node)

    def _power(self, node: sp.Expr) -> sp.Expr:
        base, exponent = node.base, node.exp
        if exponent.is_Integer:
            return self.value(base) ** exponent if exponent > 0 else self._denominator(base) ** exponent
        if exponent.is_Rational and exponent.q == 2:
            root = self._atom(sp.sqrt(base, evaluate=False) if base.is_Number else sp.sqrt(base))
            return root**exponent.p
        raise NotExactError(f"nothing is known here of the power {node}")

    def _generator(self, key: Any, text: str) -> sp.Symbol:
        """Return the generator that stands for a function; `text` is the function in Coq."""
        if key not in self._generators:
            generator = sp.Dummy(text)
            self._generators[key] = generator
            self.terms.names[generator] = f"({text})" if " " in text else text  # in brackets for powers
        return self._generators[key]

    def _relate(self, kind: str, zero: sp.Expr, tactics: str) -> None:
        name = self._name(kind)
        text = self.terms.write(zero)
        self._assert(name, f"{text} = 0", tactics)
        self.relations.append(_Relation(name, zero, text))

    def _atom(self, node: sp.Expr) -> sp.Expr:
        """Return the value of a function in generators, and add the step that proves it unless the function is a generator."""
        if node.func in _CIRCULAR:
            value, tactics = self._circular(node)
        elif node.func in _EXPONENTIAL:
            value, tactics = self._exponential(node)
        elif node.is_Pow:
            value, tactics = self._root(node)
        elif node.func is sp.Abs:
            value, tactics = self._absolute(node)
        elif isinstance(node, AppliedUndef) or node.func in _OPAQUE:
            value, tactics = self._uninterpreted(node)
        else:
            raise NotExactError(f"nothing is known here of {node.func}")
        text, image = self.terms.write(node), self.terms.write(value)
        if text not in (image, image[1:-1]):
            name = self._name("atom")
            self._assert(name, f"{text} = {image}", tactics)
            self._rewritten["atom"].append((len(text), name, False))
        return value

    def _angle(self, node: sp.Expr) -> tuple[list[tuple[sp.Expr, int]], int]:
        """Write an argument in base angles: return [(base angle, whole multiple)], and the number of quarter turns."""
        rates = _rates(node.args[0].xreplace(self.eliminated))
        quarters = rates.pop(sp.pi, sp.S.Zero) * 2
        if not quarters.is_Integer:
            raise NotExactError(f"{node} is turned by a part of a right angle")
        family = node.func in _CIRCULAR
        multiples = [(m / self._step_of[family, m], int(rate * self._step_of[family, m])) for m, rate in rates.items()]
        if any(abs(n) > _LARGEST_MULTIPLE for _, n in multiples) or abs(quarters) > _LARGEST_MULTIPLE:
            raise NotExactError(f"{node} is a large multiple of an angle")
        return multiples, int(quarters)

    def _split(self, node: sp.Expr, multiples: Iterable[tuple[sp.Expr, int]], quarters: int, tactic: str) -> str:
        """Return tactics for a function: the argument is written as a sum of base angles, then `tactic` splits this sum."""
        angles = [(self.terms.write(base), n) for base, n in multiples] + [("PI / 2", quarters)]
        copies = [f"({text})" if n > 0 else f"(- ({text}))" for text, n in angles for _ in range(abs(n))]
        function = self.terms.write(node).split(" ")[0]
        return f"transitivity ({function} ({' + '.join(copies) or '0'})); [ f_equal; {self._inner()}same | {tactic}; same ]."

    def _inner(self) -> str:
        return self.substitution.replace(". ", "; ")

    def _circular(self, node: sp.Expr) -> tuple[sp.Expr, str]:
        multiples, quarters = self._angle(node)
        cosine, sine = {0: (1, 0), 1: (0, 1), 2: (-1, 0), 3: (0, -1)}[quarters % 4]
        total = sp.Integer(cosine), sp.Integer(sine)
        for base, n in multiples:
            pair = self._pair(base)
            for _ in range(abs(n)):
                c, s = pair[0], pair[1] if n > 0 else -pair[1]
                total = sp.expand(total[0] * c - total[1] * s), sp.expand(total[1] * c + total[0] * s)
        return total[node.func is sp.sin], self._split(node, multiples, quarters, "circular")

    def _pair(self, base: sp.Expr) -> tuple[sp.Symbol, sp.Symbol]:
        """Return the cosine and the sine of a base angle, two generators with cos² + sin² = 1."""
        text, new = self.terms.alone(base), ("cos", base) not in self._generators
        pair = tuple(self._generator((name, base), f"{name} {text}") for name in ("cos", "sin"))
        if new:
            self._relate("known", pair[1] ** 2 + pair[0] ** 2 - 1, f"generalize (sine_and_cosine {text}). lra.")
        return pair[0], pair[1]

    def _exponential(self, node: sp.Expr) -> tuple[sp.Expr, str]:
        multiples, quarters = self._angle(node)
        if quarters:
            raise NotExactError(f"{node} is a power of exp(pi)")
        value = sp.S.One
        for base, n in multiples:
            new, text = ("exp", base) not in self._generators, f"exp {self.terms.alone(base)}"
            generator = self._generator(("exp", base), text)
            if new:
                self._assert(self._name("apart"), f"{text} <> 0", "apply more_than_zero, exp_pos.")
                self._nonzero.add(generator)
            value *= generator**n
        if node.func is not sp.exp:
            value = (value + (1 if node.func is sp.cosh else -1) / value) / 2
        return value, self._split(node, multiples, 0, "unfold sinh, cosh; exponential")

    def _root(self, node: sp.Expr) -> tuple[sp.Expr, str]:
        radicand = self._fraction(self.value(node.base))
        over, under = radicand.numerator.as_expr(), radicand.under
        base = sp.cancel(over / under) if not under.is_number else sp.expand(over / under)
        key = "root", base
        write = self.terms.write
        rate, root = sp.sqrt(base).as_coeff_Mul() if base.is_Rational and base > 0 else (sp.S.One, base)
        if rate != 1 or root is sp.S.One:  # the root of p²/q² or of p² n/q²
            exact = rate * (sp.S.One if root is sp.S.One else self._atom(root))
            same = in_one(self._into_generators() + self._equal(exact * exact, self.value(node.base)))
            return exact, f"apply sqrt_lem_1; [ {_NOT_NEGATIVE} | {_NOT_NEGATIVE} | {same} ]."
        if key not in self._generators:
            self._add_root(node, base)
        over, under = base.as_numer_denom()
        tactics = in_one(self._prove_value(base, node.base))
        if under.is_number:
            return self._generators[key], f"f_equal; {tactics}."
        symbol = self._generators[key]
        proof = f"transitivity (sqrt ({write(base)})); [ f_equal; {tactics} | subst {write(symbol)}; same ]."
        return symbol / under, proof

    def _add_root(self, node: sp.Expr, base: sp.Expr) -> None:
        """Add the root of a radicand as a generator; for a quotient, the generator is the root times the denominator."""
        write, under = self.terms.write, base.as_numer_denom()[1]
        same = in_one(self._prove_value(base, node.base, reverse=True))
        proof = f"replace ({write(base)}) with ({write(node.base)}) by ({same}); {_NOT_NEGATIVE}"
        tactics = f"assert (zero_1 : 0 <= {write(base)}) by ({proof}). generalize (root_squared _ zero_1). "
        if under.is_number:
            generator = self._generator(("root", base), f"sqrt {self.terms.alone(base)}")
            self._relate("root", generator**2 - base, tactics + "lra.")
            return
        name = self._name("radical")
        symbol = self._generators["root", base] = sp.Dummy(name)
        self.terms.names[symbol] = name
        root = f"sqrt ({write(base)})"
        self.steps.append(f"destruct (a_letter_for ({root} * ({write(under)}))) as [{name} {self._name('sum')}].")
        square = f"replace (({root} * ({write(under)})) ^ 2) with ({root} ^ 2 * ({write(under)}) ^ 2) by ring"
        conclusion = f"intro zero_2. subst {name}. {square}. replace ({root} ^ 2) with ({write(base)}) by lra. same."
        self._relate("root", symbol**2 - sp.expand(base * under**2), tactics + conclusion)

    def _absolute(self, node: sp.Expr) -> tuple[sp.Expr, str]:
        inner = sp.expand(self.value(node.args[0]))
        new = ("abs", inner) not in self._generators
        generator = self._generator(("abs", inner), f"Rabs {self.terms.alone(inner)}")
        if new:
            text = self.terms.write(inner)
            self._relate("known", generator**2 - inner**2, f"generalize (size_squared ({text})). lra.")
        return generator, f"f_equal; {in_one(self._prove_value(inner, node.args[0]))}."

    def _uninterpreted(self, node: sp.Expr) -> tuple[sp.Expr, str]:
        """Return the generator of an unknown function, and the proof that equal arguments give equal values."""
        inner = [sp.expand(self.value(argument)) for argument in node.args]
        alike = node.func(*inner)
        proofs = " | ".join(self._prove_value(new, old).rstrip(". ") for new, old in zip(inner, node.args, strict=True))
        return self._generator(("opaque", alike), self.terms.write(alike)), f"f_equal; first [ {in_one(proofs)} ]."

    def _prove_value(self, value: sp.Expr, node: sp.Expr, reverse: bool = False) -> str:
        """Return tactics for node = value, or value = node if `reverse`; the value is in generators."""
        return ("symmetry. " if reverse else "") + self._into_generators() + self._equal(self.value(node), value)

    def _denominator(self, base: sp.Expr, condition: str = "") -> sp.Expr:
        """Return a denominator as a product of powers of symbols; its condition proves that these symbols are not zero."""
        key = sp.Tuple(sp.Symbol("denominator"), base)
        if key in self._values:
            return self._values[key]
        fraction = self._fraction(self.value(base))
        reduced = self._reduced(fraction.numerator)[1]
        if not reduced:
            raise NotExactError(f"{base} is zero under the premises")
        number, factors = self._factor_powers(fraction.ring, reduced)
        value = number * sp.Mul(*(factor**n for factor, n in factors)) / fraction.under
        text, image = self.terms.write(base), self.terms.write(value)
        positive = bool(base.is_positive) or not condition
        names = {factor for factor, _ in factors} - self._nonzero
        if positive:
            self._show_nonzero(names)
        whole = ""
        if text not in (image, image[1:-1]):
            whole = self._name("whole")
            tactics = self._into_generators() + self._equal(self.value(base), value)
            self._assert(whole, f"{text} = {image}", tactics)
            if not base.is_Symbol or not value.is_Symbol:
                self._rewritten["whole"].append((len(text), whole, base.is_Symbol))
        if not positive:
            for factor in sorted(names, key=self.terms.write):
                closing = f"rewrite {whole}, zero_1. unfold Rdiv. ring." if whole else "exact zero_1."
                proof = f"intro zero_1. apply {condition}. {closing}"
                self._assert(self._name("apart"), f"{self.terms.write(factor)} <> 0", proof)
        self._nonzero |= names
        self._values[key] = value
        return value

    def _show_nonzero(self, factors: Iterable[sp.Symbol]) -> None:
        polynomial_of = {symbol: polynomial for polynomial, symbol in self._factors.items()}
        for factor in sorted(factors, key=self.terms.write):
            text = self.terms.write(factor)
            inner = ""
            if factor in polynomial_of:
                inner = f"replace {text} with ({self.terms.write(polynomial_of[factor])}) by congruence. "
            tactics = f"apply more_than_zero. {inner}{self.substitution}positive."
            self._assert(self._name("apart"), f"{text} <> 0", tactics)

    def _factor_powers(self, ring: PolyRing, polynomial: PolyElement) -> tuple[sp.Expr, list[tuple[sp.Symbol, int]]]:
        """Write a polynomial as a number times powers of symbols, one for each irreducible factor; return both."""
        factored = len(polynomial) <= _MOST_FACTORED
        number, factors = polynomial.factor_list() if factored else (sp.QQ(1), [(polynomial, 1)])
        powers = []
        for factor, times in factors:
            expression = factor.as_expr()
            if not expression.is_Symbol:
                lead = factor.LC
                number, expression = number * lead**times, (factor.monic()).as_expr()
                expression = self._factor(expression)
            powers.append((expression, times))
        return sp.Rational(int(number.numerator), int(number.denominator)), powers

    def _factor(self, polynomial: sp.Expr) -> sp.Symbol:
        """Return the symbol that stands for a factor of a denominator."""
        if polynomial not in self._factors:
            name = self._name("factor")
            symbol = self._factors[polynomial] = sp.Dummy(name)
            self.terms.names[symbol] = name
            equation, text = self._name("sum"), self.terms.write(polynomial)
            self.steps.append(f"destruct (a_letter_for ({text})) as [{name} {equation}].")
            self.relations.append(_Relation(equation, symbol - polynomial, ""))
        return self._factors[polynomial]

    def _fraction(self, value: sp.Expr) -> Fraction:
        return one_fraction(value, self._order(value))

    def _order(self, *values: sp.Expr) -> list[sp.Symbol]:
        """Return the generators in an order in which each relation leads with the square or symbol for which it is solved.

        The last relations come first, since a root or factor contains earlier generators.
        """
        relations = (*self.relations, *self.ideal)
        symbols = set().union(*(v.free_symbols for v in values), *(r.zero.free_symbols for r in relations))
        near = {cosine for cosine, _ in self.small_pairs(self.small).values()} if self.small else set()
        leading = [_leading(relation.zero, near) for relation in reversed(self.relations)]
        others = sorted(symbols - set(leading), key=lambda symbol: (symbol.name, str(symbol)))
        return [*dict.fromkeys(leading), *others]

    def _reduced(self, numerator: PolyElement) -> tuple[list[PolyElement], PolyElement]:
        """Divide a numerator by the relations, and return the cofactors and the remainder."""
        ring = numerator.ring
        if not self.relations or not numerator:
            return [], numerator
        return numerator.div([ring.from_expr(sp.expand(r.zero)) for r in self.relations])

    def _equal(self, lhs: sp.Expr, rhs: sp.Expr) -> str:
        """Return the tactics that prove lhs = rhs, both in the generators. Raises NotExactError if they differ."""
        difference = self._fraction(lhs - rhs)
        if not difference.numerator:
            return "same."
        quotients, remainder = self._reduced(difference.numerator)
        relations = self.relations
        if remainder and self.ideal:
            relations = [*relations, *self.ideal]
            zeros = [difference.ring.from_expr(sp.expand(r.zero)) for r in relations]
            quotients, remainder = cofactors_of(difference.numerator, zeros)
        if remainder:
            raise NotExactError("the two sides differ by more than the relations that are used here account for")
        used = [(q, r) for q, r in zip(quotients, relations, strict=True) if q and r.text]
        write = self.terms.write
        total = " + ".join(f"({write(q.as_expr())}) * ({r.text})" for q, r in used) or "0"
        names = "".join(f"rewrite {r.name}; " for _, r in used)
        factors = "".join(f"subst {self.terms.names[symbol]}; " for symbol in reversed(self._factors.values()))
        closed = f"first [{factors}same | field_simplify_eq; [ {factors}same | apart .. ]]"
        return f"apply (by_cofactors _ _ ({total}) ({write(difference.under)})); [ apart | {closed} | {names}ring ]."

    def equality(self, lhs: sp.Expr, rhs: sp.Expr) -> str:
        """Return the tactics that prove lhs = rhs of the statement."""
        values = self.value(lhs), self.value(rhs)  # these steps come first
        return self._into_generators() + self._equal(*values)

    def in_generators(self, expression: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Return the expression as a reduced polynomial over a monomial, both in generators."""
        fraction = self._fraction(self.value(expression))
        return self._reduced(fraction.numerator)[1].as_expr(), fraction.under

    def meaning(self) -> dict[sp.Symbol, sp.Expr]:
        """Return {generator: function}, and {symbol: polynomial} for the factors of denominators."""
        functions = {"cos": sp.cos, "sin": sp.sin, "exp": sp.exp, "abs": sp.Abs}
        meanings: dict[sp.Symbol, sp.Expr] = {}
        for key, symbol in self._generators.items():
            if key is sp.pi:
                meanings[symbol] = sp.pi
            elif key[0] == "root":
                meanings[symbol] = (sp.sqrt(key[1]) * _under(key[1])).xreplace(meanings)
            else:
                inner = key[1].xreplace(meanings)
                meanings[symbol] = functions[key[0]](inner) if key[0] in functions else inner
        return meanings | {symbol: polynomial.xreplace(meanings) for polynomial, symbol in self._factors.items()}

    def small_pairs(self, small: sp.Symbol) -> dict[sp.Expr, tuple[sp.Symbol, sp.Symbol]]:
        """Return {base angle: (cosine, sine)} for the base angles that vanish with the small symbol."""
        keys = (key for key in self._generators if isinstance(key, tuple) and key[0] == "cos")
        vanishing = (base for _, base in keys if base.as_powers_dict().get(small, sp.S.Zero).is_positive)
        return {base: (self._generators["cos", base], self._generators["sin", base]) for base in vanishing}

    def roots(self) -> list[tuple[sp.Symbol, sp.Expr]]:
        """Return (generator, square) for each root; for a quotient the generator is the root times the denominator."""
        keys = (key for key in self._generators if isinstance(key, tuple) and key[0] == "root")
        return [(self._generators[key], sp.expand(key[1] * _under(key[1]) ** 2)) for key in keys]


def _under(radicand: sp.Expr) -> sp.Expr:
    """Return the factor by which a root is multiplied to be a generator: the denominator of the radicand, or 1 for a number."""
    under = radicand.as_numer_denom()[1]
    return sp.S.One if under.is_number else under


def _leading(zero: sp.Expr, near: set[sp.Symbol]) -> sp.Symbol:
    """Return the generator for which a relation is solved: the sine of a pair, or the cosine if the sine is small."""
    for symbol in sorted(zero.free_symbols, key=lambda x: (_rank(x) - (x in near) * 1.5, x.name)):
        if sp.Poly(zero, symbol).degree() == (1 if symbol.name.startswith("factor_") else 2):
            return symbol
    raise NotExactError(f"{zero} has no leading generator")


def _rank(symbol: sp.Symbol) -> int:
    starts = ("factor_", "radical_", "sqrt", "Rabs", "sin ")
    return next((i for i, start in enumerate(starts) if symbol.name.startswith(start)), len(starts))


def _rates(argument: sp.Expr) -> dict[sp.Expr, sp.Rational]:
    """Return {monomial: rational factor} for the terms of an angle."""
    rates: dict[sp.Expr, Any] = {}
    for term in sp.Add.make_args(sp.expand(argument)):
        rate, monomial = term.as_coeff_Mul()
        if not rate.is_Rational:
            raise NotExactError(f"the argument {argument} is not exact")
        rates[monomial] = rates.get(monomial, sp.S.Zero) + rate
    return {monomial: rate for monomial, rate in rates.items() if rate}


def _steps_of_angles(
    expressions: Iterable[sp.Expr], substitution: dict[sp.Symbol, sp.Expr]
) -> dict[tuple[bool, sp.Expr], int]:
    """Return {(circular or not, monomial): common denominator of the factors} for the angles of all expressions."""
    denominators: dict[tuple[bool, sp.Expr], int] = {}
    for expression in expressions:
        for node in sp.preorder_traversal(expression):
            if node.func in (*_CIRCULAR, *_EXPONENTIAL, *QUOTIENTS):
                circular = node.func not in (*_EXPONENTIAL, sp.tanh, sp.coth, sp.sech, sp.csch)
                for monomial, rate in _rates(node.args[0].xreplace(substitution)).items():
                    key = circular, monomial
                    denominators[key] = lcm(denominators.get(key, 1), int(rate.q))
    return denominators


def in_one(tactics: str) -> str:
    """Join a sequence of tactics into one tactic."""
    return re.sub(r"(?<!\.)\. ", "; ", tactics.rstrip(". "))
