"""Parts from which the paper's figures are drawn: bodies, arrows, arcs and panels."""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.pictures.figures import Picture as Picture
    from lagrotor.pictures.panels import arc as arc
    from lagrotor.pictures.panels import arc_between as arc_between
    from lagrotor.pictures.panels import arrow as arrow
    from lagrotor.pictures.panels import bare as bare
    from lagrotor.pictures.panels import canvas as canvas
    from lagrotor.pictures.panels import distance_over_one_turn as distance_over_one_turn
    from lagrotor.pictures.panels import draw_wheel as draw_wheel
    from lagrotor.pictures.panels import ground as ground
    from lagrotor.pictures.panels import label as label
    from lagrotor.pictures.panels import orbits_from_above as orbits_from_above
    from lagrotor.pictures.panels import over_one_turn as over_one_turn
    from lagrotor.pictures.panels import path_arrow as path_arrow
    from lagrotor.pictures.panels import rate_figure as rate_figure
    from lagrotor.pictures.panels import shock_figure as shock_figure
    from lagrotor.pictures.panels import shock_script as shock_script

__getattr__, __dir__, __all__ = face(__name__)
