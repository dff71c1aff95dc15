"""Parameters of the obstacle layer, named as those of Nav2's layers.

``obstacle_layer.…`` has the names of VoxelLayer and ObstacleLayer, ``range_layer.…``
those of RangeSensorLayer; :class:`SourceParams` are ``obstacle_layer.SOURCE.…``.
"""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.navigation.costmap.layers.voxels import MAX_VOXELS
from navette.params import Params, param

DATA_TYPES = ("LaserScan", "PointCloud2", "Range", "HazardDetectionVector")


@dataclass(frozen=True, kw_only=True)
class ObstacleLayerParams(Params):
    """What all sources have in common."""

    observation_sources: str = param(
        "", "names of the sources, separated by spaces; empty: no layer"
    )
    resolution_m: float = param(
        0.05, "edge of a column of voxels", at_least=0.01, at_most=1.0
    )
    origin_z: float = param(0.0, "height of the lowest voxels, m")
    z_resolution: float = param(0.1, "height of a voxel, m", at_least=0.01, at_most=10)
    z_voxels: int = param(
        20, "number of voxels in a column", at_least=1, at_most=MAX_VOXELS
    )
    mark_threshold: int = param(
        0,
        "a column is an obstacle with more marked voxels than this",
        at_least=0,
        at_most=MAX_VOXELS,
    )
    footprint_clearing_enabled: bool = param(
        True, "clear the columns under the robot's footprint"
    )
    bump_persistence_s: float = param(
        60.0,
        "how long the place of a contact remains an obstacle: no other sensor saw it",
        at_least=0.0,
    )


@dataclass(frozen=True, kw_only=True)
class SourceParams(Params):
    """A source of observations: ``obstacle_layer.SOURCE.topic``, …"""

    topic: str = param("", "topic of the messages")
    data_type: str = param("PointCloud2", "type of the messages", choices=DATA_TYPES)
    sensor_frame: str = param(
        "", "frame of the sensor; empty: that of the message's header"
    )
    marking: bool = param(True, "whether the hits mark obstacles")
    clearing: bool = param(True, "whether the rays clear voxels")
    min_obstacle_height: float = param(
        0.08, "lower hits mark nothing: the floor with its noise, m"
    )
    max_obstacle_height: float = param(
        2.0, "higher hits mark nothing: the robot passes below, m"
    )
    obstacle_min_range: float = param(0.0, "nearer hits mark nothing, m", at_least=0.0)
    obstacle_max_range: float = param(
        3.0, "farther hits mark nothing, m", above=0.0, at_most=1000.0
    )
    raytrace_min_range: float = param(
        0.0, "rays clear from this range on, m", at_least=0.0
    )
    raytrace_max_range: float = param(
        4.0, "rays clear up to this range, m", above=0.0, at_most=1000.0
    )
    inf_is_valid: bool = param(True, "LaserScan: whether a beam without an echo clears")
    expected_update_rate: float = param(
        0.0,
        "seconds after which a source without a message is stale: no costmap is "
        "published and the robot stops; 0: never",
        at_least=0.0,
    )
    max_drop_height: float = param(
        0.1,
        "a hit this far below the floor shows a drop, whose edge is marked, m; 0: off",
        at_least=0.0,
        at_most=10.0,
    )

    def check(self) -> None:
        if self.min_obstacle_height >= self.max_obstacle_height:
            raise ParameterError(
                f"min_obstacle_height {self.min_obstacle_height:g}: must be below "
                f"max_obstacle_height, {self.max_obstacle_height:g}"
            )


@dataclass(frozen=True, kw_only=True)
class RangeLayerParams(Params):
    """What all sources of type Range have in common."""

    phi: float = param(
        1.2, "range at which the certainty of a reading is a half, m", above=0.0
    )
    mark_threshold: float = param(
        0.8, "probability above which a cell is an obstacle", above=0.5, at_most=0.97
    )
    no_readings_timeout: float = param(
        0.0,
        "seconds without a reading after which a source is stale: no costmap is "
        "published and the robot stops; 0: never",
        at_least=0.0,
    )
    clear_on_max_reading: bool = param(
        True, "whether a reading without an echo clears the cone"
    )
