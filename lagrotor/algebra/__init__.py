"""Exact algebra: the decision of identities and truncated power series."""

from lagrotor.algebra.identity import Decision, decide_equal, decide_zero, normal_form
from lagrotor.algebra.power_series import LeadingTerm, agreement_order, leading_term, truncated_series

__all__ = [
    "Decision",
    "LeadingTerm",
    "agreement_order",
    "decide_equal",
    "decide_zero",
    "leading_term",
    "normal_form",
    "truncated_series",
]
