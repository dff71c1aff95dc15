"""The node ``explorer``: drive to frontiers of the map until none is left.

The node sends goals of ``navigate_to_pose`` and replaces the goal as soon as its
frontier has been seen. Exploration ends with a reason: ``complete`` (no frontier is
left), ``unreachable`` (the remaining ones cannot be driven to), ``no_map``,
``no_server``, ``canceled`` (someone cancelled or replaced a goal).

The map is searched for frontiers in a worker: with the system clock the callbacks of
the node continue meanwhile.
"""

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

from navette.msgs import topics
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import PoseStamped, Quaternion
from navette.msgs.nav2_msgs.action import NavigateToPose
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.grids import GridSpec, MapPart
from navette.navigation.grids.spec import Cells
from navette.navigation.missions.explore.frontiers import (
    Exploration,
    Frontier,
    FrontierParams,
    FrontierSearch,
)
from navette.navigation.missions.explore.params import ExplorerParams
from navette.navigation.servers.map_reader_node import (
    MAP_UPDATES_INPUT,
    MapReaderNode,
)
from navette.runtime.action import ActionClient
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input
from navette.runtime.time import ns_to_stamp

COMPLETE = "complete"
UNREACHABLE = "unreachable"
NO_MAP = "no_map"
NO_SERVER = "no_server"
CANCELED = "canceled"
TIME_LIMIT = "time_limit"
_PERIOD_S = 0.5
# A map without frontiers must be followed by another one before it counts as complete:
# the first map may be empty.
_MAPS_TO_BE_SURE = 2


@dataclass(frozen=True)
class ExplorationReport:
    """Result of an exploration.

    Attributes:
        reason: why it ended; empty while it runs.
        coverage: share of the boundary of the known free space that is not a frontier:
            1 when everything reachable has been seen.
        free_m2, known_m2: areas of the map.
        time_s: time since the first map.
        path_length_m: distance driven.
        goals: number of goals sent; ``failed`` of them were not reached.
        frontiers_left: remaining frontiers, unreachable ones included.
    """

    reason: str = ""
    coverage: float = 0.0
    free_m2: float = 0.0
    known_m2: float = 0.0
    time_s: float = 0.0
    path_length_m: float = 0.0
    goals: int = 0
    failed: int = 0
    frontiers_left: int = 0

    @property
    def succeeded(self) -> bool:
        """Whether everything that the robot can reach has been seen."""
        return self.reason in (COMPLETE, UNREACHABLE)

    def to_json(self) -> str:
        """Return one JSON object; numbers to four places."""
        values = {
            key: round(value, 4) if isinstance(value, float) else value
            for key, value in asdict(self).items()
        }
        return json.dumps(values)


class _WholeMap(NamedTuple):
    """Cells of a map that are not changed, and their geometry."""

    cells: Cells
    spec: GridSpec


_Change = MapPart | _WholeMap | FrontierParams
"""A part of the map that changed, or all of it, or new parameters."""


class ExplorerNode(MapReaderNode):
    """Send goals at frontiers until the map is complete."""

    PARAMS = ExplorerParams
    FIXED_AT_START = ("lethal_cost",)
    INPUTS = (
        Input.of(topics.MAP, "the map whose frontiers are explored", callback="on_map"),
        MAP_UPDATES_INPUT,
        Input.of(
            topics.ODOMETRY,
            "position of the robot",
            rate_hz=10.0,
            callback="on_odometry",
        ),
    )

    params: ExplorerParams

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("explorer", **kwargs)
        params = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._client = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.report = ExplorationReport()
        #: Called once when the exploration has ended.
        self.on_done: Callable[[], None] | None = None
        #: Called when a goal is sent.
        self.on_goal: Callable[[Frontier, ExplorationReport], None] | None = None
        self._maps_without_frontier = 0
        self._started_ns: int | None = None
        self._created_ns = self._now_ns
        self._position: tuple[float, float] | None = None
        self._target: Frontier | None = None
        self._sent = 0
        # Frontiers whose goals failed, or were reached and showed nothing new.
        self._failed: list[Frontier] = []
        self._visited: list[Frontier] = []
        self._failures = 0
        self._has_retried = False
        #: Used by the worker only.
        self._search: FrontierSearch | None = None
        self._changes: list[_Change] = []  # that the search has not got yet
        self._is_searching = False
        self.create_timer(_PERIOD_S, self._check)

    @property
    def done(self) -> bool:
        return bool(self.report.reason)

    def on_new_map(self, part: MapPart | None) -> None:
        """Choose the next goal if there is none or its frontier has been seen."""
        if self.done:
            return
        if part is None:
            self._changes.clear()
        self._changes.append(self._whole_map if part is None else part)
        if self._started_ns is None:
            self._started_ns = self._now_ns
        self._choose()

    @property
    def _whole_map(self) -> "_WholeMap":
        assert self._maps.map is not None, "a map has arrived"
        return _WholeMap(self._maps.map.cells, self._maps.map.spec)

    def on_odometry(self, msg: Odometry) -> None:
        """Update the robot's position and the distance driven."""
        if not self._tracker.update(msg):
            return
        pose = self._tracker.latest
        assert pose is not None, "the tracker accepted the odometry"
        if self._position is not None and self._started_ns is not None:
            driven = math.dist(self._position, (pose.x, pose.y))
            length = self.report.path_length_m + driven
            self.report = replace(self.report, path_length_m=length)
        self._position = (pose.x, pose.y)

    def end(self, reason: str) -> None:
        """End the exploration and cancel the goal under way."""
        if self.done:
            return
        self._update(reason=reason)
        self._sent += 1  # results of the goal under way do not count any more
        if self._handle is not None:
            self._handle.cancel_goal_async()
        if self.on_done is not None:
            self.on_done()

    _handle: Any = None

    @property
    def _now_ns(self) -> int:
        return self.get_clock().now_ns

    def _check(self) -> None:
        waited_s = (self._now_ns - self._created_ns) / 1e9
        if self.done:
            return
        if waited_s >= self.params.map_timeout_s:
            if self._maps.map is None:
                self.end(NO_MAP)
            elif not self._client.server_is_ready() and self._target is None:
                self.end(NO_SERVER)
        if not self.done and self._target is None and self._maps.map is not None:
            self._choose()

    def _choose(self) -> None:
        """Search for frontiers unless that of the goal is left, and use the result."""
        if self.done or self._is_searching:
            return
        self._is_searching = True
        changes, self._changes = self._changes, []
        here, target = self._position, self._target
        params = self.params.frontier
        failed, visited = tuple(self._failed), tuple(self._visited)

        def search() -> Exploration | None:
            searched = self._updated(changes, params)
            if here is None or (target is not None and searched.is_open(target)):
                return None
            return searched.explore(here, failed=failed, visited=visited)

        def use(found: Exploration | None) -> None:
            self._is_searching = False
            ended = (failed, visited) != (tuple(self._failed), tuple(self._visited))
            if found is not None and not ended:
                self._use(found)
            if self._changes or ended:
                self._choose()

        self.worker.run(search, use)

    def on_params_changed(self, old: ExplorerParams) -> None:
        """Use the new values from the next search on."""
        self._changes.append(self.params.frontier)

    def _updated(
        self, changes: Sequence[_Change], params: FrontierParams
    ) -> FrontierSearch:
        """Return the search after changes of the map."""
        for change in changes:
            if isinstance(change, _WholeMap):
                self._search = FrontierSearch.of(*change, params)
            elif isinstance(change, MapPart):
                assert self._search is not None, "the first map is whole"
                self._search.update(change.cells, change.window)
            elif self._search is not None:
                self._search.set_params(change)
        assert self._search is not None, "a map has arrived"
        return self._search

    def _use(self, found: Exploration) -> None:
        """Send the goal of the best frontier, or end."""
        if self.done:
            return
        self._note(found)
        if found.best is not None:
            self._maps_without_frontier = 0
            self._send(found.best)
        else:
            self._target = None
            self._end_if_sure(found)

    def _end_if_sure(self, found: Exploration) -> None:
        if self._failed and not self._has_retried:
            # What failed may be reachable from elsewhere, or on a better map.
            self._failed.clear()
            self._has_retried = True
            return
        self._maps_without_frontier += 1
        if self._maps_without_frontier >= _MAPS_TO_BE_SURE and found.free_m2 > 0:
            self.end(UNREACHABLE if found.count else COMPLETE)

    def _note(self, found: Exploration) -> None:
        self._update(
            coverage=1.0 - found.open_share,
            free_m2=found.free_m2,
            known_m2=found.known_m2,
            frontiers_left=found.count,
        )

    def _update(self, **values: Any) -> None:
        started_ns = self._now_ns if self._started_ns is None else self._started_ns
        time_s = (self._now_ns - started_ns) / 1e9
        self.report = replace(self.report, time_s=time_s, **values)

    def _send(self, frontier: Frontier) -> None:
        if not self._client.server_is_ready():
            return  # tried again with the next check
        self._target = frontier
        self._sent += 1
        number = self._sent
        goal = PoseStamped()
        goal.header.frame_id = self.params.map_frame
        goal.header.stamp = ns_to_stamp(self._now_ns)
        goal.pose.position.x, goal.pose.position.y = frontier.goal
        goal.pose.orientation = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)  # any heading
        self._update(goals=self.report.goals + 1)
        if self.on_goal is not None:
            self.on_goal(frontier, self.report)
        future = self._client.send_goal_async(NavigateToPose.Goal(pose=goal))

        def on_response(_: object) -> None:
            handle = future.result()
            if handle is None or not handle.accepted:
                self._on_result(number, frontier, GoalStatus.STATUS_ABORTED)
                return
            self._handle = handle
            result: Any = handle.get_result_async()
            result.add_done_callback(on_result)

        def on_result(result: Any) -> None:
            if not result.cancelled():  # as at the end of the program
                self._on_result(number, frontier, result.result().status)

        future.add_done_callback(on_response)

    def _on_result(self, number: int, frontier: Frontier, status: int) -> None:
        if number != self._sent or self.done:
            return  # replaced by a newer goal of this node
        self._target = self._handle = None
        if status == GoalStatus.STATUS_CANCELED:
            self.end(CANCELED)
            return
        if status == GoalStatus.STATUS_SUCCEEDED:
            # If the frontier is still there, it cannot be seen from that place.
            self._visited.append(frontier)
            self._failures = 0
        else:
            self._failed.append(frontier)
            self._failures += 1
            self._update(failed=self.report.failed + 1)
            if self._failures >= self.params.max_failures:
                self.end(UNREACHABLE)
                return
        self._choose()
