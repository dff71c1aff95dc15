"""Obstacles from further sensors: marking, clearing by ray, height band."""

from navette.navigation.costmap.layers.observation import Observation
from navette.navigation.costmap.layers.obstacle_layer import ObstacleLayer
from navette.navigation.costmap.layers.params import (
    ObstacleLayerParams,
    RangeLayerParams,
    SourceParams,
)

__all__ = [
    "Observation",
    "ObstacleLayer",
    "ObstacleLayerParams",
    "RangeLayerParams",
    "SourceParams",
]
