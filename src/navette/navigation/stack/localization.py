"""The nodes that locate the robot in a run, and their frames.

Frames are those of REP 105: ``map → odom → base``. The simulator publishes ``odom →
base`` (a filter, if it filters the odometry) and, without correction, ``map → odom``.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from navette.errors import UnknownNameError
from navette.geometry import Pose2
from navette.msgs import topics
from navette.navigation.localization.amcl.node import AmclNode
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.localization.localizer.node import LocalizerNode
from navette.runtime import StageNode
from navette.sim.params import SimParams

LOCALIZATIONS: Mapping[str, tuple[tuple[str, type[StageNode]], ...]] = MappingProxyType(
    {
        "truth": (("localizer", LocalizerNode),),
        "odometry": (("localizer", LocalizerNode),),
        "amcl": (("amcl", AmclNode),),
    }
)
"""Parameter ``localization`` of the simulator → name and class of the nodes."""

FILTER: tuple[str, type[StageNode]] = ("ekf", EkfNode)
"""The node that publishes the odometry if the simulator does not."""

_ORDER = "x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split()


def localization_nodes(sim: SimParams) -> tuple[tuple[str, type[StageNode]], ...]:
    """Return name and class of the nodes that locate the robot, in flow order."""
    if sim.localization not in LOCALIZATIONS:
        raise UnknownNameError.of("localization", sim.localization, [*LOCALIZATIONS])
    nodes = LOCALIZATIONS[sim.localization]
    return (FILTER, *nodes) if sim.filters_odometry else nodes


def localization_parameters(sim: SimParams, start: Pose2) -> dict[str, dict[str, Any]]:
    """Return node → parameters: the frames of the run and the start pose.

    Args:
        sim: parameters of the simulated robot.
        start: map_T_base at the start.
    """
    x, y, yaw = start
    values: dict[str, dict[str, Any]] = {
        "ekf": {
            "map_frame": sim.map_frame,
            "odom_frame": sim.odometry_frame,
            "world_frame": sim.odometry_frame,
            "base_link_frame": sim.base_frame,
            "frequency_hz": sim.odometry_rate_hz,
            "odom0": topics.WHEEL_ODOMETRY.name,
            "odom0_config": [name in ("vx", "vy", "vyaw") for name in _ORDER],
            "imu0": topics.IMU.name,
            "imu0_config": [name in ("yaw", "vyaw") for name in _ORDER],
            "initial_state": [x, y, 0.0, 0.0, 0.0, yaw, *[0.0] * 9],
        },
        "amcl": {
            "global_frame_id": sim.map_frame,
            "odom_frame_id": sim.odometry_frame,
            "base_frame_id": sim.base_frame,
            "seed": sim.seed,
            "set_initial_pose": True,
            "initial_pose.x": x,
            "initial_pose.y": y,
            "initial_pose.yaw": yaw,
        },
    }
    return {name: values[name] for name, _ in localization_nodes(sim) if name in values}
