"""The branch on which an expression vanishes: a minimal set of inequalities under which it is proved to be zero."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import sympy as sp

from lagrotor.algebra.analytic_proofs import Proof, proof_of_zero
from lagrotor.algebra.refutation import find_witness
from lagrotor.algebra.signs import Region, conditions, is_nonnegative, is_positive, is_real
from lagrotor.errors import NotExactError

_MOST_CONDITIONS, _MOST_SIGNS = 8, 3


def branch_of_zero(
    expression: sp.Expr, where: Region, missing: tuple[sp.Basic, ...]
) -> tuple[tuple[sp.Basic, ...], Proof]:
    """Return a minimal set of inequalities under which the expression is proved to be zero, and that proof.

    If no such set is found, the result is (), Proof(None).
    """
    natural = conditions(expression)
    if sp.false in natural:
        return (), Proof(None)
    attempts: set[tuple[sp.Basic, ...]] = set()
    for _ in range(2):  # a proof under some conditions may need further ones
        extended = missing
        for chosen in _candidates(simplify_conditions(natural, where), simplify_conditions(missing, where)):
            if not chosen or chosen in attempts or len(chosen) > _MOST_CONDITIONS:
                continue
            attempts.add(chosen)
            proof = _proof(expression, where, chosen)
            if proof.how is not None:
                return _fewest(expression, where, chosen, proof)
            extended = (*extended, *proof.missing)
        if extended == missing:
            break
        missing = tuple(dict.fromkeys(extended))
    return (), Proof(None)


def _candidates(natural: tuple[sp.Basic, ...], missing: tuple[sp.Basic, ...]) -> Iterator[tuple[sp.Basic, ...]]:
    """Yield sets of inequalities under which a proof is tried, each followed by the same set with strict inequalities.

    The first set is `natural`, the conditions for a real value. The next ones add some of the inequalities in `missing`, in
    either direction.
    """
    if sp.false in natural:  # it has no real value
        return
    missing = tuple(relation for relation in missing if relation not in (sp.true, sp.false))
    yield natural
    several = (missing[:number] for number in range(2, min(len(missing), _MOST_SIGNS) + 1))
    for some in (*((relation,) for relation in missing), *several):
        for signs in product((True, False), repeat=len(some)):
            oriented = (relation if same else _opposite(relation) for relation, same in zip(some, signs, strict=True))
            chosen = tuple(relation for relation in (*natural, *oriented) if relation != sp.true)
            if sp.false in chosen:
                continue
            yield chosen
            strict = tuple(sided(relation.gts - relation.lts, True) for relation in chosen)
            if sp.false not in strict:  # u ≥ 0 for u = 0 has no strict form
                yield strict


def _opposite(relation: sp.Basic) -> sp.Basic:
    return sided(relation.lts - relation.gts, isinstance(relation, sp.Gt | sp.Lt))


def _fewest(
    expression: sp.Expr, where: Region, chosen: tuple[sp.Basic, ...], proof: Proof
) -> tuple[tuple[sp.Basic, ...], Proof]:
    for condition in chosen:
        fewer = tuple(relation for relation in chosen if relation != condition)
        if fewer and (weaker := _proof(expression, where, fewer)).how is not None:
            chosen, proof = fewer, weaker
        elif isinstance(condition, sp.Ge | sp.Le) and is_real(condition.gts - condition.lts, where.with_(*fewer)):
            # A proof for u ≥ 0 and one for u ≤ 0 make both conditions superfluous.
            weaker = _proof(expression, where, (*fewer, _opposite(condition)))
            if weaker.how is not None:
                divisors = tuple(dict.fromkeys((*proof.divisors, *weaker.divisors)))
                chosen, proof = fewer, Proof(weaker.how, divisors)
    return chosen, proof


def _proof(expression: sp.Expr, where: Region, chosen: tuple[sp.Basic, ...]) -> Proof:
    """Return a proof of zero in the region with the chosen inequalities.

    The result is Proof(None) if no proof is found, if a counterexample is known, or if no point of that region is known.
    """
    inside = where.with_(*chosen)
    witness, enclosed = find_witness(expression, inside)
    if witness is not None or not enclosed:
        return Proof(None)
    try:
        return proof_of_zero(expression, inside)
    except NotExactError:
        return Proof(None)


def simplify_conditions(relations: tuple[sp.Basic, ...], where: Region) -> tuple[sp.Basic, ...]:
    """Return, in their simplest form, those inequalities that do not already hold in the region."""
    inequalities: dict[sp.Basic, None] = {}
    for relation in relations:
        if relation is sp.true or relation is sp.false:
            continue
        e, strict = relation.gts - relation.lts, isinstance(relation, sp.Gt | sp.Lt)
        if not e.free_symbols or (is_positive(e, where) if strict else is_nonnegative(e, where)):
            continue
        for factor in _reduced_factors(e, where):
            inequalities[sided(factor, strict)] = None
    return tuple(relation for relation in inequalities if relation not in (sp.true, sp.false))


def sided(e: sp.Expr, strict: bool) -> sp.Basic:
    """Return the inequality e > 0 (if `strict`) or e ≥ 0. If e has a leading minus sign, write it as −e < 0 or −e ≤ 0."""
    if e.could_extract_minus_sign():
        return sp.Lt(-e, 0) if strict else sp.Le(-e, 0)
    return sp.Gt(e, 0) if strict else sp.Ge(e, 0)


def _reduced_factors(e: sp.Expr, where: Region) -> list[sp.Expr]:
    """Return a list with one entry: e without factors that are positive, and without even powers if others remain."""
    content, factors = sp.factor(e).as_coeff_mul()
    factors = [_exponent(f) for f in factors if not is_positive(f, where)]
    odd = [f for f in factors if not (f.is_Pow and f.exp.is_Integer and f.exp % 2 == 0)]
    product = sp.sign(content) * sp.Mul(*(odd or factors))
    return [product if product.as_numer_denom()[1].free_symbols else sp.expand(product)]


def _exponent(f: sp.Expr) -> sp.Expr:
    """Return u if f is exp(u) − 1, which has the same sign as u; return f otherwise."""
    return (f + 1).args[0] if isinstance(f + 1, sp.exp) else f
