"""One integration of a model at a local error, without companion or estimate: what twins and references are made of."""

from typing import Any

from lagrotor import Scene
from lagrotor.models.model import Model, Observed, integrate_model


def observed(model: Model, scene: Scene, times: Any, local: float) -> Observed:
    return model.observe(scene, integrate_model(model, scene, times, local).states)
