"""Where an expression that is not zero throughout is zero: the fewest inequalities, of those that its proof wants."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import sympy as sp

from lagrotor.algebra.analytic_proofs import Proof, proof_of_zero
from lagrotor.algebra.refutation import sample
from lagrotor.algebra.signs import Region, conditions, is_nonnegative, is_positive, is_real
from lagrotor.errors import NotExactError

_MOST_CONDITIONS, _MOST_SIGNS = 8, 3


def branch_of_zero(
    expression: sp.Expr, where: Region, wanted: tuple[sp.Basic, ...]
) -> tuple[tuple[sp.Basic, ...], Proof]:
    """Inequalities under which it is proved zero, none of which can be left out, with the proof; none where none is known."""
    natural = conditions(expression)
    if sp.false in natural:
        return (), Proof(None)
    tried: set[tuple[sp.Basic, ...]] = set()
    for _ in range(2):  # under some conditions, a proof may want others
        more = wanted
        for chosen in _candidates(simplest(natural, where), simplest(wanted, where)):
            if not chosen or chosen in tried or len(chosen) > _MOST_CONDITIONS:
                continue
            tried.add(chosen)
            proof = _proof(expression, where, chosen)
            if proof.how is not None:
                return _fewest(expression, where, chosen, proof)
            more = (*more, *proof.wanted)
        if more == wanted:
            break
        wanted = tuple(dict.fromkeys(more))
    return (), Proof(None)


def _candidates(natural: tuple[sp.Basic, ...], wanted: tuple[sp.Basic, ...]) -> Iterator[tuple[sp.Basic, ...]]:
    """The conditions of a real value; with each that is wanted, then with more and more, of either sign; open regions last."""
    if sp.false in natural:  # it has no real value
        return
    wanted = tuple(one for one in wanted if one not in (sp.true, sp.false))
    yield natural
    several = (wanted[:number] for number in range(2, min(len(wanted), _MOST_SIGNS) + 1))
    for some in (*((one,) for one in wanted), *several):
        for signs in product((True, False), repeat=len(some)):
            turned = (one if same else _opposite(one) for one, same in zip(some, signs, strict=True))
            chosen = tuple(one for one in (*natural, *turned) if one != sp.true)
            if sp.false in chosen:
                continue
            yield chosen
            strict = tuple(sided(one.gts - one.lts, True) for one in chosen)
            if sp.false not in strict:  # u ≥ 0 where u is 0 throughout
                yield strict


def _opposite(relation: sp.Basic) -> sp.Basic:
    return sided(relation.lts - relation.gts, isinstance(relation, sp.Gt | sp.Lt))


def _fewest(
    expression: sp.Expr, where: Region, chosen: tuple[sp.Basic, ...], proof: Proof
) -> tuple[tuple[sp.Basic, ...], Proof]:
    for condition in chosen:
        fewer = tuple(other for other in chosen if other != condition)
        if fewer and (found := _proof(expression, where, fewer)).how is not None:
            chosen, proof = fewer, found
        elif isinstance(condition, sp.Ge | sp.Le) and is_real(condition.gts - condition.lts, where.with_(*fewer)):
            # Proved for u ≥ 0 and for u ≤ 0, it needs neither.
            found = _proof(expression, where, (*fewer, _opposite(condition)))
            if found.how is not None:
                divisors = tuple(dict.fromkeys((*proof.divisors, *found.divisors)))
                chosen, proof = fewer, Proof(found.how, divisors)
    return chosen, proof


def _proof(expression: sp.Expr, where: Region, chosen: tuple[sp.Basic, ...]) -> Proof:
    """The proof in the smaller region, where a point of it was seen and none of them refutes."""
    inside = where.with_(*chosen)
    witness, enclosed = sample(expression, inside)
    if witness is not None or not enclosed:
        return Proof(None)
    try:
        return proof_of_zero(expression, inside)
    except NotExactError:
        return Proof(None)


def simplest(relations: tuple[sp.Basic, ...], where: Region) -> tuple[sp.Basic, ...]:
    """Inequalities that are not known already, in their simplest form."""
    found: dict[sp.Basic, None] = {}
    for relation in relations:
        if relation is sp.true or relation is sp.false:
            continue
        e, strict = relation.gts - relation.lts, isinstance(relation, sp.Gt | sp.Lt)
        if not e.free_symbols or (is_positive(e, where) if strict else is_nonnegative(e, where)):
            continue
        for part in _simplest(e, where):
            found[sided(part, strict)] = None
    return tuple(relation for relation in found if relation not in (sp.true, sp.false))


def sided(e: sp.Expr, strict: bool) -> sp.Basic:
    """e > 0 or e ≥ 0, with the sign outside: x ≤ 0 for −x ≥ 0."""
    if e.could_extract_minus_sign():
        return sp.Lt(-e, 0) if strict else sp.Le(-e, 0)
    return sp.Gt(e, 0) if strict else sp.Ge(e, 0)


def _simplest(e: sp.Expr, where: Region) -> list[sp.Expr]:
    """The factors of an e >= 0 that are not known to be positive, each taken to be so."""
    content, factors = sp.factor(e).as_coeff_mul()
    factors = [_exponent(f) for f in factors if not is_positive(f, where)]
    odd = [f for f in factors if not (f.is_Pow and f.exp.is_Integer and f.exp % 2 == 0)]
    product = sp.sign(content) * sp.Mul(*(odd or factors))
    return [product if product.as_numer_denom()[1].free_symbols else sp.expand(product)]


def _exponent(f: sp.Expr) -> sp.Expr:
    """u for exp(u) − 1, which has its sign."""
    return (f + 1).args[0] if isinstance(f + 1, sp.exp) else f
