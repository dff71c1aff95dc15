"""Grids as nav_msgs/OccupancyGrid messages."""

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2, quaternion_from_yaw, yaw_of
from navette.grids.checks import grid_array
from navette.grids.spec import GridSpec
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import Point, Pose, Quaternion
from navette.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from navette.msgs.std_msgs.msg import Header


def grid_to_message(
    cells: NDArray[np.int8], spec: GridSpec, frame_id: str, stamp_ns: int
) -> OccupancyGrid:
    """A message of ``cells`` (H, W), copied; -1 unknown, 0 free … 100 lethal."""
    data = grid_array("cells", cells, np.int8, spec).reshape(-1)
    stamp = Time(sec=stamp_ns // 1_000_000_000, nanosec=stamp_ns % 1_000_000_000)
    x, y, z, w = quaternion_from_yaw(spec.origin.yaw)
    origin = Pose(
        position=Point(x=float(spec.origin.x), y=float(spec.origin.y)),
        orientation=Quaternion(x=x, y=y, z=z, w=w),
    )
    info = MapMetaData(
        map_load_time=stamp,
        resolution=spec.resolution,
        width=spec.width,
        height=spec.height,
        origin=origin,
    )
    header = Header(stamp=stamp, frame_id=frame_id)
    return OccupancyGrid(header=header, info=info, data=data)


def grid_from_message(msg: OccupancyGrid) -> tuple[NDArray[np.int8], GridSpec]:
    """Cells (H, W), a view of the message's data, and where they lie.

    Raises:
        InvalidValueError: size, resolution or origin make no grid.
    """
    info, position, q = msg.info, msg.info.origin.position, msg.info.origin.orientation
    # On the wire the resolution is a float32: the shortest decimal that reads as the
    # same gives 0.1 back for it, with or without a wire between.
    spec = GridSpec(
        float(str(np.float32(info.resolution))),
        info.width,
        info.height,
        Pose2(position.x, position.y, yaw_of((q.x, q.y, q.z, q.w))),
    )
    cells = np.asarray(msg.data)
    if cells.size != spec.width * spec.height:
        raise InvalidValueError(
            f"occupancy grid: {cells.size} cells, wanted {spec.width} x "
            f"{spec.height} = {spec.width * spec.height}"
        )
    return cells.reshape(spec.shape), spec
