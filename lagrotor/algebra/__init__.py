"""Exact algebra: the decision of identities, derivatives and truncated power series."""

from typing import TYPE_CHECKING

from lagrotor.faces import face

if TYPE_CHECKING:
    from lagrotor.algebra.differentiation import along as along
    from lagrotor.algebra.differentiation import derivative as derivative
    from lagrotor.algebra.differentiation import hessian as hessian
    from lagrotor.algebra.identity import Decision as Decision
    from lagrotor.algebra.identity import decide_equal as decide_equal
    from lagrotor.algebra.identity import decide_zero as decide_zero
    from lagrotor.algebra.identity import normal_form as normal_form
    from lagrotor.algebra.names import check_names as check_names
    from lagrotor.algebra.power_series import LeadingTerm as LeadingTerm
    from lagrotor.algebra.power_series import agreement_order as agreement_order
    from lagrotor.algebra.power_series import leading_term as leading_term
    from lagrotor.algebra.power_series import truncated_series as truncated_series

__getattr__, __dir__, __all__ = face(__name__)
