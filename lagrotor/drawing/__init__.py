"""Figures, films and interactive views of motions: colours, one style, the drawing of a rotor."""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.drawing.style import CASE_COLOURS as CASE_COLOURS
    from lagrotor.drawing.style import CASE_DASHES as CASE_DASHES
    from lagrotor.drawing.style import CORRECTION_COLOUR as CORRECTION_COLOUR
    from lagrotor.drawing.style import EXACT_COLOUR as EXACT_COLOUR
    from lagrotor.drawing.style import FORCE_COLOUR as FORCE_COLOUR
    from lagrotor.drawing.style import HIGH_ORDER_COLOUR as HIGH_ORDER_COLOUR
    from lagrotor.drawing.style import MODEL_COLOUR as MODEL_COLOUR
    from lagrotor.drawing.style import OKABE_ITO as OKABE_ITO
    from lagrotor.drawing.style import PAPER_COLOUR as PAPER_COLOUR
    from lagrotor.drawing.style import legend_below as legend_below
    from lagrotor.drawing.style import paper_style as paper_style
    from lagrotor.drawing.style import with_residual as with_residual
    from lagrotor.drawing.view import View as View
    from lagrotor.drawing.wheel import BAR as BAR
    from lagrotor.drawing.wheel import GROUND as GROUND
    from lagrotor.drawing.wheel import INK as INK
    from lagrotor.drawing.wheel import MARK as MARK
    from lagrotor.drawing.wheel import RADIUS as RADIUS
    from lagrotor.drawing.wheel import ROTORS as ROTORS
    from lagrotor.drawing.wheel import Camera as Camera

__getattr__, __dir__, __all__ = face(__name__)
