"""Costmap: laser scan in, grid of costs around the sensor out."""

from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.scan_costmap import PlanarScan, ScanCostmap

__all__ = ["CostmapParams", "PlanarScan", "ScanCostmap"]
