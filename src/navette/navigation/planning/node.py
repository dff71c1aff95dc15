"""The planner node: map, odometry and goals in, path out.

Before its first goal the node publishes no path and the status ``waiting_for_goal``. A
goal that arrives before map or odometry waits for them; the status names what is
missing. On stale odometry and on any failure the node publishes an empty path, so that
the robot stops.

Plans run in a worker: with the system clock the node's callbacks continue meanwhile. A
cancellation, a new goal or a takeover drops the plan that is computed; maps wait until
it is complete.
"""

import math
from typing import Any, ClassVar

import numpy as np

from navette.errors import InvalidInputError
from navette.geometry import Pose2, yaw_of
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PointStamped, PoseStamped
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry, Path
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.msgs.std_msgs.msg import Empty, Header
from navette.msgs.std_srvs.srv import (
    Trigger,
    Trigger_Request,
    Trigger_Response,
)
from navette.navigation.grids import NO_PART, MapPart
from navette.navigation.planning.localization_check import LocalizationCheck
from navette.navigation.planning.map_inputs import MapInputs
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planner import Goal, Planner
from navette.navigation.planning.reports import RobotMotion
from navette.navigation.planning.servers.navigator_status import NavigatorStatus
from navette.navigation.planning.servers.path_server import PathServer
from navette.navigation.planning.servers.smoother_server import SmootherServer
from navette.navigation.planning.step_runner import StepRunner
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.navigation.servers.map_reader_node import (
    MAP_UPDATES_INPUT,
    MapReaderNode,
)
from navette.runtime import Input, MessageInfo, Output
from navette.runtime.input_check import input_check
from navette.runtime.stage.commander import Commander
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import path_message
from navette.runtime.stage.status import status_output

# Period of checking the age of the odometry.
_WATCH_PERIOD_S = 0.1
# Of an invalid goal, by the reason of the input's check.
_REFUSALS = {
    "not_finite": Outcome.GOAL_NOT_FINITE,
    "out_of_range": Outcome.GOAL_OUTSIDE_MAP,
    "invalid_orientation": Outcome.GOAL_ORIENTATION_INVALID,
    "invalid_stamp": Outcome.GOAL_STAMP_INVALID,
}
_check_pose = input_check(topics.GOAL_POSE.type)
_check_point = input_check(topics.GOAL_POINT.type)
# Age of a path from which the controller's status is that of this path.
_STATUS_DELAY_NS = 200_000_000
# Status of a controller that obstacles stop.
_BLOCKED = "blocked"
# Status of a controller whose robot does not move as commanded.
_STALLED = "stalled"


class PlannerNode(MapReaderNode):
    """Plan to the newest goal until the robot has reached it."""

    PARAMS = PlannerParams
    INPUTS: ClassVar = (
        Input.of(
            topics.MAP,
            "map of everything seen so far",
            callback="on_map",
        ),
        MAP_UPDATES_INPUT,
        Input.of(
            topics.MAP_POINTS,
            "where beams ended, within the lethal cells of the map with the same stamp",
            callback="on_map_points",
        ),
        Input.of(
            topics.TRACKED_OBSTACLES,
            "moving obstacles; paths avoid where they will be",
            callback="on_moving",
        ),
        Input.of(
            topics.ODOMETRY,
            "pose and velocity",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_odometry",
            most_hz=20.0,
        ),
        Input.of(
            topics.KEEPOUT_ZONES,
            "zones that the robot must not touch",
            callback="on_keepout_zones",
        ),
        Input.of(
            topics.LOCALIZATION_STATUS,
            "whether the pose is known; without it the robot counts as localized",
            callback="on_localization_status",
            checks_contents=False,
        ),
        Input.of(
            topics.GOAL_POINT,
            "goal position, unless missions send goals",
            callback="on_goal_point",
        ),
        Input.of(
            topics.GOAL_POSE,
            "goal position and heading, unless missions send goals",
            callback="on_goal_pose",
        ),
        Input.of(
            topics.CANCEL_GOAL,
            "ends the goal, unless missions send goals",
            callback="on_cancel_goal",
        ),
        Input.of(
            topics.COMMANDER,
            "who commands; the goal is paused while it is not navigation",
            callback="on_commander",
        ),
        Input.of(
            topics.CONTROL_STATUS,
            "whether obstacles stop the controller",
            callback="on_control_status",
            checks_contents=False,
        ),
        Input.of(
            topics.PLANNER_GOAL,
            "goal of the missions; an orientation of zeros means any heading",
            callback="on_planner_goal",
            checks_contents=False,
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.PATH,
            "path to follow; empty = stop",
        ),
        Output.of(
            topics.PLAN,
            "each planned path, also on request; not followed",
        ),
        status_output(topics.PLANNER_STATUS.name),
    )

    params: PlannerParams

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("planner", **kwargs)
        self._tracker = self._new_tracker()
        navigator = Navigator(self.params)
        navigator.planner.warm_up()
        self._runner = StepRunner(
            navigator, self.worker, on_stepped=self._publish_path_and_status
        )
        self._odometry_ns: int | None = None
        self._localization = LocalizationCheck()
        self._space = MapInputs(self._maps)
        self._updates_arrived = self.create_guard_condition(self._use_updates)
        self._status = NavigatorStatus(self)
        self._path_ns = 0  # of the newest path
        self._timer = self.create_timer(self.params.plan_period_s, self.on_timer)
        self.create_timer(_WATCH_PERIOD_S, self.on_watch)
        self._lifecycle = StageLifecycle(
            self, "planner_server", on_inactive=self._end_goal
        )
        smoothing = StageLifecycle(self, "smoother_server")
        self._smoother_server = SmootherServer(self, host=self, activation=smoothing)
        self._path_server = PathServer(self, host=self, activation=self._lifecycle)
        self.create_service(Trigger, "~/cancel", self.on_cancel)
        self.create_service(Trigger, "~/avoid_place", self.on_avoid_place)
        self._report()

    def on_control_status(self, msg: DiagnosticStatus) -> None:
        """Plan at once if obstacles stop the controller; end the goal if it failed."""
        path_age_ns = self._now_ns - self._path_ns
        if msg.message == Outcome.METHOD_FAILED and self._navigator.has_path:
            if path_age_ns < _STATUS_DELAY_NS:
                return  # the status may be that of the previous path
            self._runner.drop()
            self._navigator.fail(Outcome.METHOD_FAILED)
            self._publish_path_and_status()
        elif msg.message == _STALLED and self._navigator.has_path:
            self._navigator.note_stalled(self._now_ns)
            self.on_timer()
        elif msg.message == _BLOCKED and self._navigator.has_path:
            self._runner.change(lambda: self._navigator.note_blocked())
            self.on_timer()

    def on_moving(self, msg: ObstacleArray) -> None:
        """Store the moving obstacles for the next step."""
        self._space.receive_moving(msg, self.params.map_frame)

    def on_map_points(self, msg: PointCloud2) -> None:
        """Store where beams ended; usually it arrives before the map of its stamp."""
        if self._space.receive_points(msg):
            self.on_new_map(NO_PART)

    def on_map_update(self, msg: OccupancyGridUpdate, info: MessageInfo) -> None:
        """Store a part of the map that changed until the next callback.

        The whole map of its stamp has usually arrived then, and is used without a copy:
        that of 200 m takes 40 ms if it needs new memory.
        """
        self._receive_update(msg, info)
        self._updates_arrived.trigger()

    def _use_updates(self) -> None:
        try:
            self._apply_updates()
        except InvalidInputError as error:
            self.drop_input(topics.MAP_UPDATES.name, error)

    def on_new_map(self, part: MapPart | None) -> None:
        """Use the map; a path that it blocks is replaced at once."""
        change = self._space.change(part)
        # The worker may still be busy with a request, or a step that was dropped.
        self._runner.change(
            lambda: change.apply(self._navigator, is_shared=self.worker.is_busy)
        )
        self.on_timer()

    def on_keepout_zones(self, msg: OccupancyGrid) -> None:
        """Plan around zones; a path through them is replaced at once."""
        self._space.receive_zones(msg, self.params.map_frame)
        if self._space.has_map:
            self.on_new_map(None)

    def on_odometry(self, msg: Odometry) -> None:
        """Update the robot's pose; detect arrival at once."""
        jumps = self._tracker.jumps
        if not self._tracker.update(msg):
            return
        self._odometry_ns = self._now_ns
        self._navigator.planner.put_down_at = self._tracker.first
        if self._tracker.jumps != jumps:
            self._runner.change(lambda: self._navigator.note_jump())
            self.on_timer()
        robot = self._robot()
        if robot is None or self._localization.unlocated or self._runner.is_stepping:
            return
        if self._navigator.note(robot, self._now_ns):
            self._publish_path_and_status()

    def on_localization_status(self, msg: DiagnosticStatus) -> None:
        """Stop a robot that is lost; continue when it is localized again."""
        if self._localization.receive(msg.message, self._now_ns):
            self._runner.drop()
            self.on_timer()

    def on_goal_point(self, msg: PointStamped) -> None:
        """Navigate to a point, with any heading, if no missions forward it."""
        if not self._missions_send_goals():
            self._set_goal(msg.header, Goal(msg.point.x, msg.point.y))

    def on_goal_pose(self, msg: PoseStamped) -> None:
        """Navigate to a pose, if no missions forward it."""
        if not self._missions_send_goals():
            self._set_goal(msg.header, _goal(msg))

    def on_planner_goal(self, msg: PoseStamped) -> None:
        """Navigate to a pose, or to a point if the orientation is zero."""
        q = msg.pose.orientation
        if any((q.x, q.y, q.z, q.w)):
            _check_pose(msg)
            self._set_goal(msg.header, _goal(msg))
        else:
            point = PointStamped(header=msg.header, point=msg.pose.position)
            _check_point(point)
            self._set_goal(msg.header, Goal(point.point.x, point.point.y))

    def on_input_dropped(self, topic: str, msg: Any, error: InvalidInputError) -> None:
        """Refuse an invalid goal, and stop."""
        if topic == topics.GOAL_POINT.name:
            goal = Goal(msg.point.x, msg.point.y)
        elif topic in (topics.GOAL_POSE.name, topics.PLANNER_GOAL.name):
            goal = Goal(msg.pose.position.x, msg.pose.position.y)
        else:
            return
        self._runner.drop()
        self._navigator.refuse_goal(goal, _REFUSALS[error.reason])
        self._report(is_logged=True)
        self._publish_path_and_status()

    def on_cancel(
        self, request: Trigger_Request, response: Trigger_Response
    ) -> Trigger_Response:
        """End the goal (``canceled``) and stop the robot."""
        response.success = True
        had_goal = self._end_goal()
        response.message = "goal cancelled" if had_goal else "no goal was active"
        return response

    def _end_goal(self) -> bool:
        """Cancel the goal and stop the robot; return whether there was one."""
        self._runner.drop()
        had_goal = self._navigator.cancel()
        self._publish_path_and_status()
        return had_goal

    def on_cancel_goal(self, msg: Empty) -> None:
        """End the goal, if no missions do that."""
        if not self._missions_send_goals():
            self._end_goal()

    def on_avoid_place(
        self, request: Trigger_Request, response: Trigger_Response
    ) -> Trigger_Response:
        """Plan around the place where the robot got stuck."""
        self._runner.drop()
        response.success = self._navigator.avoid_place()
        found = "the place ahead is avoided" if response.success else "no such place"
        response.message = found
        return response

    def on_commander(self, msg: DiagnosticStatus) -> None:
        """Pause while navigation is masked."""
        commander = Commander.of(msg)
        masked = commander.masks(self.resolve_topic_name(topics.CMD_VEL_NAV.name))
        if masked and not self._navigator.is_paused:
            self._runner.drop()
            self._navigator.pause(self._now_ns)
        elif self._navigator.is_paused and not masked:
            self._runner.drop()
            self._navigator.resume(self._now_ns)
            self.on_timer()
        self._publish_path_and_status()

    def on_timer(self) -> None:
        """Step the navigator."""
        self._localization.update(self._now_ns)
        if self._runner.is_stepping:
            self._runner.then(self.on_timer)
            return
        self._navigator.planner.map.set_moving(self._space.moving_at(self._now_ns))
        robot, now_ns, stale = self._robot(), self._now_ns, self._is_stale()
        unlocated = self._localization.unlocated
        self._runner.run(
            lambda navigator: navigator.step(
                robot, now_ns, stale=stale, unlocated=unlocated
            )
        )

    def on_watch(self) -> None:
        """Stop the robot as soon as its odometry is stale."""
        if self._navigator.has_path and self._is_stale():
            self.on_timer()

    def on_params_changed(self, old: PlannerParams) -> None:
        """Plan again with the new values."""
        params = self.params
        if (params.base_frame, params.map_frame) != (old.base_frame, old.map_frame):
            self._tracker, self._odometry_ns = self._new_tracker(), None
        if params.plan_period_s != old.plan_period_s:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(params.plan_period_s, self.on_timer)
        self._runner.drop()
        self._navigator.configure(params)

    def on_time_jump(self) -> None:
        """Drop the goal, stop the robot, and wait for the next goal.

        The map is kept until another arrives: it may be published only once.
        """
        self._runner.drop()
        had_path = self._navigator.has_path
        self._tracker.reset()
        self._odometry_ns = None
        was_paused = self._navigator.is_paused
        self._runner.navigator = Navigator(self.params)
        if was_paused:
            self._navigator.pause(self._now_ns)
        self._space.restore(self._navigator)
        if had_path:
            empty = path_message(np.empty((0, 3)), self.params.map_frame, self._now_ns)
            self.publish(topics.PATH.name, empty)
        self._report()

    @property
    def _navigator(self) -> Navigator:
        return self._runner.navigator

    @property
    def _now_ns(self) -> int:
        return self.get_clock().now_ns

    def _new_tracker(self) -> PoseTracker:
        return PoseTracker(self, self.params.base_frame, self.params.map_frame)

    def _robot(self) -> RobotMotion | None:
        pose = self._tracker.latest
        return None if pose is None else RobotMotion(pose, *self._tracker.velocity)

    def frame_on_map(self, frame_id: str) -> Pose2 | None:
        """Return the pose of a frame in the map frame; None if unknown."""
        return self._tracker.frame_on_map(frame_id)

    def planner_with_map(self) -> Planner | None:
        return self._navigator.planner if self._space.has_map else None

    def fresh_pose(self) -> Pose2 | None:
        return (
            None
            if self._localization.unlocated or self._is_stale()
            else self._tracker.latest
        )

    def _is_stale(self) -> bool:
        if self._odometry_ns is None:
            return True
        age_ns = self._now_ns - self._odometry_ns
        # Negative: the clock was set back, and the message is of an earlier run.
        return not 0 <= age_ns <= self.params.odometry_timeout_s * 1e9

    def _missions_send_goals(self) -> bool:
        return self.count_publishers(topics.PLANNER_GOAL.name) > 0

    def _set_goal(self, header: Header, goal: Goal) -> None:
        map_T_frame = self._frame_of_goal(header.frame_id)
        self._runner.drop()
        if map_T_frame is None:
            self._navigator.refuse_goal(goal, Outcome.UNKNOWN_FRAME)
            self.get_logger().error(
                f"goal in unknown frame {header.frame_id!r}; expected a frame on /tf"
            )
        else:
            self._navigator.set_goal(_moved(goal, map_T_frame), self._now_ns)
        if not self._lifecycle.is_active:
            self.get_logger().warning("goal refused: planner_server is not active")
            self._navigator.cancel()
        self._report()
        self.on_timer()

    def _frame_of_goal(self, frame_id: str) -> Pose2 | None:
        """Return the present map_T_frame, or None for an unknown frame."""
        map_frame = self.params.map_frame
        if not frame_id:
            self.get_logger().warning(f"goal without a frame: {map_frame!r} is assumed")
        return self._tracker.frame_on_map(frame_id or map_frame)

    def _publish_path_and_status(self) -> None:
        poses = self._navigator.take_path()
        if poses is not None:
            message = path_message(poses, self.params.map_frame, self._now_ns)
            self.hand_over(topics.PATH.name, message)
            self._path_ns = self._now_ns
            if len(poses):
                self.publish_plan(message)
        self._report()

    def publish_plan(self, path: Path) -> None:
        if self.has_listeners(topics.PLAN.name):
            self.hand_over(topics.PLAN.name, path)

    def _report(self, *, is_logged: bool = False) -> None:
        self._status.report(self._navigator.report, is_logged=is_logged)


def _goal(msg: PoseStamped) -> Goal:
    position, q = msg.pose.position, msg.pose.orientation
    return Goal(position.x, position.y, yaw_of((q.x, q.y, q.z, q.w)))


def _moved(goal: Goal, map_T_frame: Pose2) -> Goal:
    """Transform a goal from its frame to the map."""
    if not (math.isfinite(goal.x) and math.isfinite(goal.y)):
        return goal
    moved = map_T_frame @ Pose2(goal.x, goal.y, goal.yaw or 0.0)
    return Goal(moved.x, moved.y, None if goal.yaw is None else moved.yaw)
