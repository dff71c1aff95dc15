"""What is dangerous around the robot: laser scan in, costmap out."""

from navette.costmap.params import CostmapParams
from navette.costmap.scan_costmap import Scan, ScanCostmap

__all__ = ["CostmapParams", "Scan", "ScanCostmap"]
