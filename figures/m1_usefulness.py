"""Where each closed form of the paired orbit stops being useful, over amplitude and spin ratio."""

from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lagrotor.benchmark.limits.error_map import USEFUL, Usefulness, usefulness
from lagrotor.pictures.benchmark_figures import stability_figure

TITLE = "Range of use of the closed forms"
ALT = (
    "Three maps, for orders 1, 3 and 5, show the error of the closed form. The axes are the amplitude from 0.01 to 0.5 and "
    "the departure from opposite spins from one in a million to three tenths. In each map a line bounds the region at the "
    "lower left in which the form is useful."
)


@cache
def data() -> Usefulness:
    """Every scene of the grid over one turn, exact, beside the series of orders 1, 3 and 5."""
    return usefulness(np.geomspace(0.01, 0.5, 16), np.geomspace(1e-6, 0.3, 24))


def _edge(axis: np.ndarray, errors: np.ndarray, allowed: np.ndarray) -> float:
    """Where errors cross what is allowed, between neighbours on logarithmic scales."""
    return float(np.exp(np.interp(0.0, np.log(errors / allowed), np.log(axis))))


def measure() -> dict[str, float]:
    """The amplitude, for opposite spins, and the departure, at the least amplitude, at which each order stops being useful."""
    found, edges = data(), {}
    for order, errors in zip(found.orders, found.errors, strict=True):
        if (errors[0] > USEFUL * found.amplitudes).any():
            edges[f"amplitude, order {order}"] = _edge(found.amplitudes, errors[0], USEFUL * found.amplitudes)
        edges[f"departure at r0 = 0.01, order {order}"] = _edge(
            found.departures, errors[:, 0], np.full(len(found.departures), USEFUL * 0.01)
        )
    return edges


def caption() -> str:
    edges = measure()
    reach = ", ".join(f"{edges[key]:.2f} ({key.split(', ')[1]})" for key in edges if key.startswith("amplitude"))
    apart = edges["departure at r0 = 0.01, order 5"]
    return (
        "The error of the series of order 1 (a), 3 (b) and 5 (c) is the largest distance of an axis from the exact axis "
        "over the first turn, for a massless bar as long as the "
        f"axes and a spin of 10 rad/s. On the line it is {USEFUL:g} of the amplitude. With opposite spins the line lies at "
        f"r0 = {reach}. If the spins depart from opposite ones by a fraction of {apart:.3f}, the error reaches this value at any "
        "small amplitude and order."
    )


CAPTION = caption()


def figure() -> Figure:
    return stability_figure(data())
