"""Mapping: costmaps and poses in, one map out."""

from navette.navigation.mapping.gate import FusionGate
from navette.navigation.mapping.memory import BodyMotion, MapMemory, PlacedCostmap
from navette.navigation.mapping.params import MapMemoryParams

__all__ = ["MapMemoryParams", "MapMemory", "BodyMotion", "PlacedCostmap", "FusionGate"]
