"""Costmap: laser scan in, grid of costs around the sensor out."""

from navette.navigation.costmap.own_costmap import ScanArrays, make_costmap
from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.scan_costmap import ScanCostmap
from navette.navigation.grids import PlanarScan

__all__ = ["CostmapParams", "PlanarScan", "ScanArrays", "ScanCostmap", "make_costmap"]
