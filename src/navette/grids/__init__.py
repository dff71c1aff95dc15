"""Grid arrays: cells, rays, distance, inflation, resampling."""

from navette.grids.spec import GridSpec

__all__ = ["GridSpec"]
