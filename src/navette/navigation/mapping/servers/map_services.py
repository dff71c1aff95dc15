"""Nav2's map_server and map_saver: load, get and save a map."""

from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry.map_files import (
    OccupancyMap,
    read_cells,
    read_description,
    write_occupancy_map,
)
from navette.msgs.nav2_msgs.srv import LoadMap, SaveMap
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.nav_msgs.srv import GetMap
from navette.navigation.grids import FREE, LETHAL, GridSpec, grid_from_message
from navette.runtime import Future
from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.exceptions import InvalidTopicNameException
from navette.runtime.node import Node
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.worker import Worker

_SAVE_TIMEOUT_S = 6.0  # for the message of another topic; slam publishes every 5 s
_FREE_THRESHOLD, _OCCUPIED_THRESHOLD = 0.25, 0.65  # of map_saver


class MapStore(Protocol):
    """The node whose map the services load and save."""

    def map_topics(self) -> tuple[str, ...]:
        """Return the full names of the topics on which the map is published."""

    def newest_grid(self) -> OccupancyGrid:
        """Return the map as it was last published, or updated."""

    def load_map(self, cells: NDArray[np.int8], spec: GridSpec) -> None:
        """Replace the map and publish it."""

    @property
    def worker(self) -> Worker:
        """Where files are read and written."""

    @property
    def is_probability_map(self) -> bool:
        """Whether values of 1 … 99 are probabilities, not costs."""


class MapServices:
    """``map_server/load_map``, ``map_server/map``, ``map_saver/save_map``."""

    def __init__(self, node: Node, *, store: MapStore) -> None:
        self._node, self._store = node, store
        node.create_service(LoadMap, "map_server/load_map", self._load)
        node.create_service(GetMap, "map_server/map", self._get)
        # Waiting for another topic does not keep the node from mapping.
        self._group = ReentrantCallbackGroup()
        node.create_service(
            SaveMap, "map_saver/save_map", self._save, callback_group=self._group
        )

    async def _load(self, request: Any, response: Any) -> Any:
        path = _path(request.map_url)
        if path is None or not _exists(path):
            self._error(f"map {request.map_url!r} not loaded: the file does not exist")
            response.result = response.RESULT_MAP_DOES_NOT_EXIST
            return response
        response.result = response.RESULT_INVALID_MAP_METADATA
        try:
            described = read_description(path)
            response.result = response.RESULT_INVALID_MAP_DATA
            cells: Any = await self._store.worker.submit(lambda: read_cells(described))
            height, width = cells.shape
            spec = GridSpec(described.resolution, width, height, described.origin)
        except (FileFormatError, InvalidValueError) as error:
            self._error(f"map not loaded: {error}")
            return response
        self._store.load_map(cells, spec)
        response.map = self._store.newest_grid()
        response.result = response.RESULT_SUCCESS
        self._node.get_logger().info(f"map loaded: {path}, {width} x {height} cells")
        return response

    def _get(self, request: Any, response: Any) -> Any:
        response.map = self._store.newest_grid()
        return response

    async def _save(self, request: Any, response: Any) -> Any:
        path = _path(request.map_url)
        try:
            grid, own = await self._grid(request.map_topic)
        except InvalidTopicNameException as error:
            self._error(f"map not saved: {error}")
            return response
        if path is None or grid is None:
            missing = "map_url is empty" if path is None else "no map has arrived"
            self._error(f"map of {request.map_topic or 'map'!r} not saved: {missing}")
            return response
        mode = request.map_mode or "trinary"
        has_costs = own and not self._store.is_probability_map

        def write() -> Path:
            cells, spec = grid_from_message(grid)
            if has_costs and mode == "trinary":
                # Costs below that of an obstacle are of free cells.
                cells = np.where((cells > FREE) & (cells < LETHAL), FREE, cells)
            return write_occupancy_map(
                path,
                OccupancyMap(cells, spec.resolution, spec.origin),
                mode=mode,
                image_format=request.image_format.lower(),
                free_threshold=request.free_thresh or _FREE_THRESHOLD,
                occupied_threshold=request.occupied_thresh or _OCCUPIED_THRESHOLD,
            )

        try:
            written = await self._store.worker.submit(write)
        except (OSError, ValueError) as error:
            self._error(f"map not saved: {error}")
            return response
        self._node.get_logger().info(f"map saved: {written}")
        response.result = True
        return response

    async def _grid(self, topic: str) -> tuple[OccupancyGrid | None, bool]:
        """Return the newest map of a topic, and whether it is the own one."""
        name = self._node.resolve_topic_name(topic or "map")
        if name in self._store.map_topics():
            return self._store.newest_grid(), True
        arrived: Future[OccupancyGrid | None] = Future()

        def end(message: OccupancyGrid | None) -> None:
            if not arrived.done():
                arrived.set_result(message)

        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        subscription = self._node.create_subscription(
            OccupancyGrid, name, end, qos, callback_group=self._group
        )
        timer = self._node.create_timer(
            _SAVE_TIMEOUT_S, lambda: end(None), callback_group=self._group
        )
        try:
            return await arrived, False
        finally:
            self._node.destroy_timer(timer)
            self._node.destroy_subscription(subscription)

    def _error(self, text: str) -> None:
        self._node.get_logger().error(text)


def _path(url: str) -> Path | None:
    """Return the path of a URL or path of a file; None if it is empty."""
    text = url.removeprefix("file://")
    if not text:
        return None
    try:
        return Path(text).expanduser()
    except RuntimeError:  # a user without a home
        return Path(text)


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # such as a name that is too long
        return False
