"""What the robot remembers: costmaps in, one map out."""

from navette.navigation.mapping.gate import FusionGate
from navette.navigation.mapping.memory import MapMemory, Motion, PlacedCostmap
from navette.navigation.mapping.params import MapMemoryParams

__all__ = ["MapMemoryParams", "MapMemory", "Motion", "PlacedCostmap", "FusionGate"]
