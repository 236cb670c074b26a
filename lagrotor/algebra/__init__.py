"""Exact algebra: decision of identities, signs and domains of expressions, derivatives and truncated power series.

The modules in the order in which `identity.decide_zero` uses them:

- `scalar` checks the expression, and `numbering` numbers its symbols, so that no decision depends on their names.
- `reading` writes it as a quotient of polynomials in its `generators`: symbols, square roots, cosines, sines, exponentials.
  The zero polynomial proves zero. `roots`, `reduction` and `algebraic_numbers` treat radicals and their relations.
- `translation` replaces other functions by symbols with relations. `analytic_proofs`, `sums` and `integrals` use induction,
  derivatives and antiderivatives.
- `refutation` searches for a counterexample, a point where `enclosures` exclude zero.
- `signs` and `feasibility` decide inequalities; `branches` finds the fewest inequalities under which an identity holds.
- `power_series` expands an expression and finds the first order at which two expressions differ.

A new function needs rules in `translation`, an enclosure in `special_enclosures` and its sign in `signs`. No module decides by
`simplify` or by sympy's automatic evaluation.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.algebra.differentiation import along as along
    from lagrotor.algebra.differentiation import derivative as derivative
    from lagrotor.algebra.differentiation import hessian as hessian
    from lagrotor.algebra.identity import Decision as Decision
    from lagrotor.algebra.identity import decide_equal as decide_equal
    from lagrotor.algebra.identity import decide_zero as decide_zero
    from lagrotor.algebra.identity import normal_form as normal_form
    from lagrotor.algebra.power_series import LeadingTerm as LeadingTerm
    from lagrotor.algebra.power_series import agreement_order as agreement_order
    from lagrotor.algebra.power_series import leading_term as leading_term
    from lagrotor.algebra.power_series import truncated_series as truncated_series

__getattr__, __dir__, __all__ = face(__name__)
