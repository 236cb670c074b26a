"""One scene for each model that `simulate` may choose and for each kind of program; `x` near 1 changes the motion a little."""

from collections.abc import Callable

from lagrotor import Link, Scene, Shock, paired_scene

SCENES: dict[str, Callable[[float], Scene]] = {
    "free rotors": lambda x: Scene(
        (10 * x, 5), link=None, axes=((0.6, 0, 0.8), (0, 0, 1)), rates=((0, 0.5, 0), (0.2, 0, 0))
    ),
    "massless bar, shock": lambda x: Scene((10, -10 * x), shock=Shock((40 * x, -11, 0), 1, 0.05)),
    "short bar, shock": lambda x: Scene((10, 5), link=Link(0.7, 0.5, 0.1), shock=Shock((30 * x, 20, 0), 0.5, 0.05)),
    "long bar, shock": lambda x: Scene((10, 5), link=Link(1.7, 0.5, 0.1), shock=Shock((30 * x, 20, 0), 0.5, 0.05)),
    "equal spins, shock": lambda x: Scene((10, 10), link=Link(1, 0.5, 0.1), shock=Shock((30 * x, 20, 0), 0.5, 0.05)),
    "small shock": lambda x: Scene((10, -7), link=Link(1, 0.5, 0.1), shock=Shock((1e-4 * x, 0, 0), 0.5, 0.05)),
    "paired precession": lambda x: paired_scene(Scene((10, -10)), 0.05 * x),
}
