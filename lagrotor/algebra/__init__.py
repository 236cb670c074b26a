"""Exact algebra: the decision of identities, the signs and domains of expressions, derivatives and truncated power
series.

A question passes through the modules in this order:

- `identity.decide_zero` is asked whether an expression vanishes. `scalar` checks the expression, and `numbering`
  gives its symbols an order that no name changes.
- `reading` brings it to a quotient of polynomials in its `generators`: symbols, square roots, cosines, sines,
  exponentials. The zero polynomial is the proof. `roots`, `reduction` and `algebraic_numbers` treat radicals and
  relations.
- For other functions `translation` replaces each unknown function by a symbol with the relations that are known of
  it. `analytic_proofs`, `sums` and `integrals` use induction, derivatives and antiderivatives.
- `refutation` looks for a point at which `enclosures` exclude zero. A `Decision` is "zero", "nonzero" with the point,
  or undecided.
- `signs` and `feasibility` decide inequalities, and `branches` names the fewest under which an identity holds.
- `power_series` expands about a point and finds the first order at which two expressions differ.

A new function needs its rules in `translation`, its enclosure in `special_enclosures` and its sign in `signs`. No
module decides by `simplify` or by sympy's automatic evaluation.
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
