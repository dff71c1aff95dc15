"""Conversion of grids from and to messages: whole grids and windows of them."""

import functools

import numpy as np

from navette.errors import InvalidValueError
from navette.geometry import Pose2, quaternion_from_yaw, yaw_of
from navette.geometry.messages import header, time_message
from navette.msgs import copy_message
from navette.msgs.geometry_msgs.msg import Point, Pose, Quaternion
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from navette.navigation.grids.checks import grid_array
from navette.navigation.grids.spec import Cells, GridSpec
from navette.navigation.grids.windows import CellWindow


def grid_to_message(
    cells: Cells, spec: GridSpec, frame_id: str, stamp_ns: int
) -> OccupancyGrid:
    """Return a message with a copy of ``cells`` (H, W).

    Raises:
        InvalidValueError: ``cells`` does not have the spec's shape.
    """
    data = grid_array("cells", cells, np.int8, spec).reshape(-1)
    info = _geometry(spec)
    info.map_load_time = time_message(stamp_ns)
    return OccupancyGrid(header=header(stamp_ns, frame_id), info=info, data=data)


def _geometry(spec: GridSpec) -> MapMetaData:
    x, y, z, w = quaternion_from_yaw(spec.origin.yaw)
    origin = Pose(
        position=Point(x=float(spec.origin.x), y=float(spec.origin.y)),
        orientation=Quaternion(x=x, y=y, z=z, w=w),
    )
    return MapMetaData(
        resolution=float(np.float32(spec.resolution)),  # as in a copy
        width=spec.width,
        height=spec.height,
        origin=origin,
    )


def resize_grid_message(msg: OccupancyGrid, spec: GridSpec) -> None:
    """Change the extent of a message in its memory; its cells are not valid then."""
    data = msg.data
    added = spec.width * spec.height - len(data)
    if added < 0:
        del data[added:]
    else:
        data.frombytes(bytes(added))
    msg.info = _geometry(spec)


def update_grid_message(
    msg: OccupancyGrid,
    cells: Cells,
    window: CellWindow,
    frame_id: str,
    stamp_ns: int,
) -> None:
    """Make a message of ``cells`` (H, W) from one that differs in a window only."""
    present = np.asarray(msg.data).reshape(cells.shape)
    present[window.slices] = cells[window.slices]
    msg.header = header(stamp_ns, frame_id)
    info = copy_message(msg.info)  # a reader may still have that of the last message
    info.map_load_time = time_message(stamp_ns)
    msg.info = info


def grid_from_message(msg: OccupancyGrid) -> tuple[Cells, GridSpec]:
    """Return the cells (H, W), a view of the message's data, and their geometry.

    Raises:
        InvalidValueError: the size does not match the data, or the resolution or
            origin is out of range.
    """
    info, position, q = msg.info, msg.info.origin.position, msg.info.origin.orientation
    spec = GridSpec(
        _resolution(info.resolution),
        info.width,
        info.height,
        Pose2(position.x, position.y, yaw_of((q.x, q.y, q.z, q.w))),
    )
    cells = np.asarray(msg.data)
    if cells.size != spec.width * spec.height:
        raise InvalidValueError(
            f"occupancy grid: {cells.size} cells, expected {spec.width} x "
            f"{spec.height} = {spec.width * spec.height}"
        )
    return cells.reshape(spec.shape), spec


@functools.lru_cache(maxsize=16)
def _resolution(value: float) -> float:
    """Return the shortest decimal of a serialised resolution, which is a float32.

    Thus 0.1 is restored, whether the message was serialised or not.
    """
    return float(str(np.float32(value)))


def window_to_message(
    cells: Cells, window: CellWindow, frame_id: str, stamp_ns: int
) -> OccupancyGridUpdate:
    """Return a message with a copy of the window of ``cells`` (H, W)."""
    height, width = window.shape
    return OccupancyGridUpdate(
        header=header(stamp_ns, frame_id),
        x=window.first_column,
        y=window.first_row,
        width=width,
        height=height,
        data=cells[window.slices].reshape(-1),
    )


def window_from_message(
    msg: OccupancyGridUpdate, spec: GridSpec
) -> tuple[Cells, CellWindow]:
    """Return the cells (h, w), a view of the message's data, and where they belong.

    Raises:
        InvalidValueError: the size does not match the data, or the window is not
            within the grid.
    """
    window = CellWindow(msg.y, msg.y + msg.height, msg.x, msg.x + msg.width)
    cells = np.asarray(msg.data)
    if cells.size != msg.width * msg.height:
        raise InvalidValueError(
            f"grid update: {cells.size} cells, expected {msg.width} x {msg.height} = "
            f"{msg.width * msg.height}"
        )
    if window.grown(0, spec.shape) != window:
        raise InvalidValueError(
            f"grid update: columns {window.first_column} to {window.last_column}, rows "
            f"{window.first_row} to {window.last_row}; the grid has {spec.width} x "
            f"{spec.height} cells"
        )
    return cells.reshape(window.shape), window
