"""What the robot remembers: costmaps in, one map out."""

from navette.mapping.gate import FusionGate
from navette.mapping.memory import MapMemory, Motion, PlacedCostmap
from navette.mapping.params import MapMemoryParams

__all__ = ["MapMemoryParams", "MapMemory", "Motion", "PlacedCostmap", "FusionGate"]
