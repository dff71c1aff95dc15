"""Services of the SLAM's map, under Navette's, Nav2's and slam_toolbox's names."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.msgs.nav2_msgs.srv import SaveMap
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.nav_msgs.srv import GetMap
from navette.msgs.slam_toolbox import srv as toolbox
from navette.msgs.std_srvs.srv import Empty
from navette.navigation.grids import grid_from_message
from navette.navigation.slam.graph_file import SUFFIX, read_graph, write_graph
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.scan_graph import ScanGraph
from navette.runtime.node import Node
from navette.runtime.worker import Worker

# Name of a map without one, as of map_saver in the current folder.
_UNNAMED = "map"
_FAILED = (OSError, ValueError, RuntimeError)


class MapSession(Protocol):
    """The node whose map the services save, load and restart."""

    @property
    def params(self) -> SlamParams:
        """The present parameters."""

    @property
    def key_scans(self) -> int:
        """Number of scans in the map."""

    @property
    def is_paused(self) -> bool:
        """Whether scans are left out."""

    @property
    def worker(self) -> Worker:
        """Where maps are drawn, and files written and read."""

    async def copied_graph(self) -> ScanGraph:
        """Return a copy of the present scans and poses."""

    async def map_drawer(self) -> Callable[[], OccupancyGrid]:
        """Return what draws the present map, in the worker."""

    def continue_map(self, graph: ScanGraph, start: Pose2, *, is_mapping: bool) -> None:
        """Continue a map at a rough pose of the robot, or localize in it."""

    async def empty_map(self) -> None:
        """Begin a new map where the robot is."""

    def restart(self) -> None:
        """Begin as at the start of the node."""

    def pause(self, is_paused: bool) -> None:
        """Leave scans out, or use them again."""


class SlamMapServices:
    """``slam/…`` with Nav2's types, and ``slam_toolbox/…`` with slam_toolbox's."""

    def __init__(self, node: Node, *, session: MapSession) -> None:
        self._node, self._session = node, session
        node.create_service(SaveMap, "slam/save_map", self._save)
        node.create_service(Empty, "slam/restart", self._restart)
        for kind, name, callback in (
            (toolbox.SaveMap, "save_map", self._save_image),
            (toolbox.SerializePoseGraph, "serialize_map", self._serialize),
            (toolbox.DeserializePoseGraph, "deserialize_map", self._deserialize),
            (toolbox.Pause, "pause_new_measurements", self._pause),
            (toolbox.Reset, "reset", self._reset),
            (GetMap, "dynamic_map", self._get),
        ):
            node.create_service(kind, f"slam_toolbox/{name}", callback)

    async def _save(self, request: Any, response: Any) -> Any:
        """Write MAP.yaml and its image, and MAP.slam to continue the map."""
        draw = await self._session.map_drawer()
        graph = await self._session.copied_graph()

        def write() -> str:
            stem = _stem(request.map_url, "map_url")
            written = _write_image(
                stem,
                draw(),
                mode=request.map_mode or "trinary",
                image_format=request.image_format.lower(),
            )
            write_graph(_with_suffix(stem), graph)
            return f"{written}, and {stem.name}{SUFFIX}"

        response.result = await self._saved("map", write)
        return response

    async def _save_image(self, request: Any, response: Any) -> Any:
        """Write NAME.yaml and its image."""
        if not self._session.key_scans:
            self._error("map not saved: no scan has arrived")
            response.result = response.RESULT_NO_MAP_RECEIEVD
            return response
        draw = await self._session.map_drawer()
        name = request.name.data or _UNNAMED
        is_saved = await self._saved(
            "map", lambda: _write_image(_stem(name, "name"), draw())
        )
        response.result = (
            response.RESULT_SUCCESS if is_saved else response.RESULT_UNDEFINED_FAILURE
        )
        return response

    async def _serialize(self, request: Any, response: Any) -> Any:
        """Write FILENAME.slam: scans and pose graph."""
        graph = await self._session.copied_graph()

        def write() -> Path:
            path = _with_suffix(_stem(request.filename, "filename"))
            if not len(graph):
                raise InvalidValueError("no scan has arrived")
            write_graph(path, graph)
            return path

        response.result = (
            response.RESULT_SUCCESS
            if await self._saved("scans", write)
            else response.RESULT_FAILED_TO_WRITE_FILE
        )
        return response

    async def _saved(self, what: str, write: Callable[[], Path | str]) -> bool:
        """Write files; log their names, or the failure; return whether it worked."""
        try:
            written = await self._session.worker.submit(write)
        except _FAILED as error:
            self._error(f"{what} not saved: {error}")
            return False
        self._info(f"{what} saved: {written}")
        return True

    async def _deserialize(self, request: Any, response: Any) -> Any:
        """Continue the map FILENAME.slam, or localize in it.

        The log and the status have the outcome: the response has no field in ROS 2
        Jazzy and Kilted. Rolling's definition has result codes, and another hash.
        """
        kinds = (
            request.START_AT_FIRST_NODE,
            request.START_AT_GIVEN_POSE,
            request.LOCALIZE_AT_POSE,
        )
        try:
            if request.match_type not in kinds:
                raise InvalidValueError(
                    f"match_type {request.match_type}; expected 1 (at the first scan), "
                    "2 (at initial_pose) or 3 (at initial_pose, the map stays as it is)"
                )
            path = _with_suffix(_stem(request.filename, "filename"))
            params = self._session.params
            graph: Any = await self._session.worker.submit(
                lambda: read_graph(path, params)
            )
            start = graph.pose(0)
            if request.match_type != request.START_AT_FIRST_NODE:
                given = request.initial_pose
                start = Pose2(given.x, given.y, given.theta)
        except _FAILED as error:
            self._error(f"map not loaded: {error}")
            return response
        is_mapping = request.match_type != request.LOCALIZE_AT_POSE
        self._session.continue_map(graph, start, is_mapping=is_mapping)
        verb = "continued" if is_mapping else "used for localization"
        self._info(f"{path}: {len(graph)} scans, {verb}")
        return response

    def _pause(self, _: Any, response: Any) -> Any:
        """Pause, or continue."""
        self._session.pause(not self._session.is_paused)
        response.status = True
        return response

    async def _reset(self, request: Any, response: Any) -> Any:
        """Begin a new map where the robot is."""
        await self._session.empty_map()
        self._session.pause(request.pause_new_measurements)
        response.result = response.RESULT_SUCCESS
        return response

    def _restart(self, _: Any, response: Any) -> Any:
        """Begin again as at the start of the node."""
        self._session.restart()
        return response

    async def _get(self, _: Any, response: Any) -> Any:
        if self._session.key_scans:
            draw = await self._session.map_drawer()
            response.map = await self._session.worker.submit(draw)
        return response

    def _error(self, text: str) -> None:
        self._node.get_logger().error(text)

    def _info(self, text: str) -> None:
        self._node.get_logger().info(text)


def _write_image(stem: Path, grid: OccupancyGrid, **options: Any) -> Path:
    cells, spec = grid_from_message(grid)
    drawn = OccupancyMap(cells, spec.resolution, spec.origin)
    return write_occupancy_map(stem, drawn, **options)


def _stem(url: str, field: str) -> Path:
    """Return the path of a map without the suffix of its scans."""
    path = Path(url.removeprefix("file://")).expanduser()
    if not path.name:
        raise InvalidValueError(f"{field} is empty; expected the path of a file")
    return path.with_suffix("") if path.suffix == SUFFIX else path


def _with_suffix(stem: Path) -> Path:
    return stem.with_name(stem.name + SUFFIX)
