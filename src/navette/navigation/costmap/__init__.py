"""What is dangerous around the robot: laser scan in, costmap out."""

from navette.navigation.costmap.params import CostmapParams
from navette.navigation.costmap.scan_costmap import Scan, ScanCostmap

__all__ = ["CostmapParams", "Scan", "ScanCostmap"]
