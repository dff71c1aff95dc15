"""Maps of ROS's map_server: a YAML file that describes an image."""

from navette.geometry.map_files.description import (
    MAP_MODES,
    MapDescription,
    read_description,
)
from navette.geometry.map_files.reader import (
    OccupancyMap,
    read_cells,
    read_occupancy_map,
)
from navette.geometry.map_files.writer import IMAGE_FORMATS, write_occupancy_map

__all__ = [
    "IMAGE_FORMATS",
    "MAP_MODES",
    "MapDescription",
    "OccupancyMap",
    "read_cells",
    "read_description",
    "read_occupancy_map",
    "write_occupancy_map",
]
