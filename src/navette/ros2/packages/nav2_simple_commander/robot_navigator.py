"""Commands for a robot that navigates: go to poses, follow paths, recover, clear maps.

Each command returns when its goal was accepted; then ``isTaskComplete()`` runs the node
for a moment and returns whether the task has ended. Names and behaviour are those of
Nav2's ``nav2_simple_commander`` (Jazzy).
"""

# ruff: noqa: N802 - the names are Nav2's

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

from navette import runtime
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import (
    Point,
    PoseStamped,
    PoseWithCovarianceStamped,
)
from navette.msgs.known_fields import several_poses
from navette.msgs.lifecycle_msgs.srv import GetState
from navette.msgs.nav2_msgs.action import (
    AssistedTeleop,
    BackUp,
    ComputePathThroughPoses,
    ComputePathToPose,
    DockRobot,
    DriveOnHeading,
    FollowGPSWaypoints,
    FollowPath,
    FollowWaypoints,
    NavigateThroughPoses,
    NavigateToPose,
    SmoothPath,
    Spin,
    UndockRobot,
)
from navette.msgs.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCostmap,
    LoadMap,
    ManageLifecycleNodes,
)
from navette.msgs.nav_msgs.msg import Path
from navette.runtime import (
    ActionClient,
    Client,
    DurabilityPolicy,
    Duration,
    Future,
    Node,
    QoSProfile,
)

_RETRY_S = 1.0
_STEP_S = 0.1
_MANAGER = "nav2_msgs/srv/ManageLifecycleNodes"


class TaskResult(Enum):
    """How a task ended."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


_RESULTS = {
    GoalStatus.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.STATUS_ABORTED: TaskResult.FAILED,
    GoalStatus.STATUS_CANCELED: TaskResult.CANCELED,
}


class BasicNavigator(Node):
    """Client of the navigation stack.

    Args:
        node_name: name of the node.
        namespace: namespace of the robot.
        options: further arguments of :class:`Node`, such as ``context``.
    """

    def __init__(
        self, node_name: str = "basic_navigator", namespace: str = "", **options: Any
    ) -> None:
        super().__init__(node_name=node_name, namespace=namespace, **options)
        self.initial_pose = PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self._pose_future: Any = runtime.Future()
        self.goal_handle: Any = None
        self.result_future: Any = None
        self.feedback: Any = None
        self.status: int | None = None
        self._create_action_clients()
        self._create_service_clients()
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.localization_pose_sub = self.create_subscription(
            PoseWithCovarianceStamped, "amcl_pose", self._amclPoseCallback, latched
        )
        self.initial_pose_pub = self.create_publisher(
            PoseWithCovarianceStamped, "initialpose", 10
        )

    def _create_action_clients(self) -> None:
        def action(kind: Any, name: str) -> ActionClient:
            return ActionClient(self, kind, name)

        self.nav_through_poses_client = action(
            NavigateThroughPoses, "navigate_through_poses"
        )
        self.nav_to_pose_client = action(NavigateToPose, "navigate_to_pose")
        self.follow_waypoints_client = action(FollowWaypoints, "follow_waypoints")
        self.follow_gps_waypoints_client = action(
            FollowGPSWaypoints, "follow_gps_waypoints"
        )
        self.follow_path_client = action(FollowPath, "follow_path")
        self.compute_path_to_pose_client = action(
            ComputePathToPose, "compute_path_to_pose"
        )
        self.compute_path_through_poses_client = action(
            ComputePathThroughPoses, "compute_path_through_poses"
        )
        self.smoother_client = action(SmoothPath, "smooth_path")
        self.spin_client = action(Spin, "spin")
        self.backup_client = action(BackUp, "backup")
        self.drive_on_heading_client = action(DriveOnHeading, "drive_on_heading")
        self.assisted_teleop_client = action(AssistedTeleop, "assisted_teleop")
        self.docking_client = action(DockRobot, "dock_robot")
        self.undocking_client = action(UndockRobot, "undock_robot")

    def _create_service_clients(self) -> None:
        local, overall = "local_costmap", "global_costmap"
        self.change_maps_srv = self.create_client(LoadMap, "map_server/load_map")
        self.clear_costmap_global_srv = self.create_client(
            ClearEntireCostmap, f"{overall}/clear_entirely_{overall}"
        )
        self.clear_costmap_local_srv = self.create_client(
            ClearEntireCostmap, f"{local}/clear_entirely_{local}"
        )
        self.clear_costmap_except_region_srv = self.create_client(
            ClearCostmapExceptRegion, f"{local}/clear_costmap_except_region"
        )
        self.clear_costmap_around_robot_srv = self.create_client(
            ClearCostmapAroundRobot, f"{local}/clear_costmap_around_robot"
        )
        self.clear_costmap_around_pose_srv = self.create_client(
            ClearCostmapAroundPose, f"{local}/clear_costmap_around_pose"
        )
        self.get_costmap_global_srv = self.create_client(
            GetCostmap, f"{overall}/get_costmap"
        )
        self.get_costmap_local_srv = self.create_client(
            GetCostmap, f"{local}/get_costmap"
        )

    def destroyNode(self) -> None:
        self.destroy_node()

    # Localization

    def setInitialPose(self, initial_pose: PoseStamped) -> None:
        """Publish the robot's pose for the localization."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        self._setInitialPose()

    # Tasks

    def goToPose(self, pose: PoseStamped, behavior_tree: str = "") -> bool:
        """Drive to a pose; return whether the goal was accepted."""
        goal = NavigateToPose.Goal(pose=pose, behavior_tree=behavior_tree)
        x, y = pose.pose.position.x, pose.pose.position.y
        self.info(f"Navigating to goal: {x} {y}...")
        return self._start(self.nav_to_pose_client, goal, f"Goal to {x} {y}")

    def goThroughPoses(
        self, poses: Sequence[PoseStamped], behavior_tree: str = ""
    ) -> bool:
        """Drive through poses to the last one."""
        goal = NavigateThroughPoses.Goal(behavior_tree=behavior_tree)
        goal.poses = several_poses(NavigateThroughPoses.Goal, "poses", poses)
        self.info(f"Navigating with {len(poses)} goals....")
        what = f"Goal with {len(poses)} poses"
        return self._start(self.nav_through_poses_client, goal, what)

    def followWaypoints(self, poses: Sequence[PoseStamped]) -> bool:
        """Drive to one pose after another; missed ones are in the result."""
        self.info(f"Following {len(poses)} goals....")
        goal = FollowWaypoints.Goal(poses=list(poses))
        what = f"Following {len(poses)} waypoints request"
        return self._start(self.follow_waypoints_client, goal, what)

    def followGpsWaypoints(self, gps_poses: Sequence[Any]) -> bool:
        """Drive to one geographic pose after another."""
        self.info(f"Following {len(gps_poses)} gps goals....")
        goal = FollowGPSWaypoints.Goal(gps_poses=list(gps_poses))
        what = f"Following {len(gps_poses)} gps waypoints request"
        return self._start(self.follow_gps_waypoints_client, goal, what)

    def followPath(
        self, path: Path, controller_id: str = "", goal_checker_id: str = ""
    ) -> bool:
        """Follow a path."""
        self.info("Executing path...")
        goal = FollowPath.Goal(
            path=path, controller_id=controller_id, goal_checker_id=goal_checker_id
        )
        return self._start(self.follow_path_client, goal, "Follow path")

    def spin(self, spin_dist: float = 1.57, time_allowance: float = 10) -> bool:
        """Turn in place by an angle (rad)."""
        self.info(f"Spinning to angle {spin_dist}....")
        goal = Spin.Goal(
            target_yaw=float(spin_dist), time_allowance=_span(time_allowance)
        )
        return self._start(self.spin_client, goal, "Spin request")

    def backup(
        self,
        backup_dist: float = 0.15,
        backup_speed: float = 0.025,
        time_allowance: float = 10,
    ) -> bool:
        """Drive straight backwards (m, m/s)."""
        self.info(f"Backing up {backup_dist} m at {backup_speed} m/s....")
        goal = BackUp.Goal(
            target=Point(x=float(backup_dist)),
            speed=float(backup_speed),
            time_allowance=_span(time_allowance),
        )
        return self._start(self.backup_client, goal, "Backup request")

    def driveOnHeading(
        self, dist: float = 0.15, speed: float = 0.025, time_allowance: float = 10
    ) -> bool:
        """Drive straight ahead (m, m/s)."""
        self.info(f"Drive {dist} m on heading at {speed} m/s....")
        goal = DriveOnHeading.Goal(
            target=Point(x=float(dist)),
            speed=float(speed),
            time_allowance=_span(time_allowance),
        )
        return self._start(
            self.drive_on_heading_client, goal, "Drive On Heading request"
        )

    def assistedTeleop(self, time_allowance: float = 30) -> bool:
        """Let an operator drive on ``cmd_vel_teleop``, with collision checks."""
        self.info("Running 'assisted_teleop'....")
        goal = AssistedTeleop.Goal(time_allowance=_span(time_allowance))
        return self._start(self.assisted_teleop_client, goal, "Assisted Teleop request")

    def dockRobotByPose(
        self, dock_pose: PoseStamped, dock_type: str, nav_to_dock: bool = True
    ) -> bool:
        """Dock at a pose."""
        goal = DockRobot.Goal(
            use_dock_id=False,
            dock_pose=dock_pose,
            dock_type=dock_type,
            navigate_to_staging_pose=nav_to_dock,
        )
        self.info(f"Docking at pose: {dock_pose}...")
        return self._start(self.docking_client, goal, "Docking request")

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> bool:
        """Dock at a known dock."""
        goal = DockRobot.Goal(
            use_dock_id=True, dock_id=dock_id, navigate_to_staging_pose=nav_to_dock
        )
        self.info(f"Docking at dock ID: {dock_id}...")
        return self._start(self.docking_client, goal, "Docking request")

    def undockRobot(self, dock_type: str = "") -> bool:
        """Leave the dock."""
        self.info(f"Undocking from dock of type: {dock_type}...")
        goal = UndockRobot.Goal(dock_type=dock_type)
        return self._start(self.undocking_client, goal, "Undocking request")

    # State of the task

    def cancelTask(self) -> None:
        """Request the end of the task; it ends when the robot is at rest."""
        self.info("Canceling current task.")
        if self.result_future is not None:
            self._spin_until(self.goal_handle.cancel_goal_async())

    def isTaskComplete(self) -> bool:
        """Run the node for up to 0.1 s; return whether the task has ended."""
        if self.result_future is None:
            return True
        runtime.spin_until_future_complete(
            self, self.result_future, timeout_sec=_STEP_S
        )
        response = self.result_future.result()
        if response is None:
            return not self.context.ok()
        self.status = response.status
        if self.status == GoalStatus.STATUS_SUCCEEDED:
            self.debug("Task succeeded!")
        else:
            self.debug(f"Task with failed with status code: {self.status}")
        return True

    def getFeedback(self) -> Any:
        """Return the newest feedback message, or None."""
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return how the last task ended."""
        return _RESULTS.get(self.status, TaskResult.UNKNOWN)  # type: ignore[arg-type] # None is UNKNOWN

    def waitUntilNav2Active(
        self, navigator: str = "bt_navigator", localizer: str = "amcl"
    ) -> None:
        """Wait for the nodes to be active and for the robot's pose."""
        if localizer != "robot_localization":  # has no lifecycle
            self._waitForNodeToActivate(localizer)
        if localizer == "amcl":
            self._waitForInitialPose()
        self._waitForNodeToActivate(navigator)
        self.info("Nav2 is ready for use!")

    # Paths

    def getPath(
        self,
        start: PoseStamped,
        goal: PoseStamped,
        planner_id: str = "",
        use_start: bool = False,
    ) -> Path | None:
        """Return a path to a goal; None if there is none."""
        request = ComputePathToPose.Goal(
            start=start, goal=goal, planner_id=planner_id, use_start=use_start
        )
        return self._path(self.compute_path_to_pose_client, request, "Get path")

    def getPathThroughPoses(
        self,
        start: PoseStamped,
        goals: Sequence[PoseStamped],
        planner_id: str = "",
        use_start: bool = False,
    ) -> Path | None:
        """Return a path through goals; None if there is none."""
        request = ComputePathThroughPoses.Goal(
            start=start, planner_id=planner_id, use_start=use_start
        )
        request.goals = several_poses(ComputePathThroughPoses.Goal, "goals", goals)
        return self._path(self.compute_path_through_poses_client, request, "Get path")

    def smoothPath(
        self,
        path: Path,
        smoother_id: str = "",
        max_duration: float = 2.0,
        check_for_collision: bool = False,
    ) -> Path | None:
        """Return the smoothed path; None if it cannot be smoothed."""
        request = SmoothPath.Goal(
            path=path,
            max_smoothing_duration=_span(max_duration),
            smoother_id=smoother_id,
            check_for_collisions=check_for_collision,
        )
        return self._path(self.smoother_client, request, "Smooth path")

    # Maps

    def changeMap(self, map_filepath: str) -> None:
        """Load another map."""
        response = self._call(
            self.change_maps_srv, LoadMap.Request(map_url=map_filepath), "change map"
        )
        if response is None or response.result != LoadMap.Response.RESULT_SUCCESS:
            self.error("Change map request failed!")
        else:
            self.info("Change map request was successful!")

    def clearAllCostmaps(self) -> None:
        """Clear the local and the global costmap."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        request = ClearEntireCostmap.Request()
        self._call(self.clear_costmap_local_srv, request, "Clear local costmaps")

    def clearGlobalCostmap(self) -> None:
        request = ClearEntireCostmap.Request()
        self._call(self.clear_costmap_global_srv, request, "Clear global costmaps")

    def clearCostmapExceptRegion(self, reset_distance: float) -> None:
        """Clear the local costmap except around the robot."""
        request = ClearCostmapExceptRegion.Request(reset_distance=reset_distance)
        client = self.clear_costmap_except_region_srv
        self._call(client, request, "ClearCostmapExceptRegion")

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear the local costmap around the robot."""
        request = ClearCostmapAroundRobot.Request(reset_distance=reset_distance)
        client = self.clear_costmap_around_robot_srv
        self._call(client, request, "ClearCostmapAroundRobot")

    def clearCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear the local costmap around a pose."""
        request = ClearCostmapAroundPose.Request(
            pose=pose, reset_distance=reset_distance
        )
        client = self.clear_costmap_around_pose_srv
        self._call(client, request, "ClearCostmapAroundPose")

    def getGlobalCostmap(self) -> Any:
        """Return the global costmap."""
        request = GetCostmap.Request()
        response = self._call(
            self.get_costmap_global_srv, request, "Get global costmaps"
        )
        return None if response is None else response.map

    def getLocalCostmap(self) -> Any:
        """Return the local costmap."""
        request = GetCostmap.Request()
        response = self._call(self.get_costmap_local_srv, request, "Get local costmaps")
        return None if response is None else response.map

    # Lifecycle

    def lifecycleStartup(self) -> None:
        """Start the nodes of every lifecycle manager."""
        self.info("Starting up lifecycle nodes based on lifecycle_manager.")
        self._manage(ManageLifecycleNodes.Request.STARTUP, "Starting up")
        self.info("Nav2 is ready for use!")

    def lifecycleShutdown(self) -> None:
        """Shut down the nodes of every lifecycle manager."""
        self.info("Shutting down lifecycle nodes based on lifecycle_manager.")
        self._manage(ManageLifecycleNodes.Request.SHUTDOWN, "Shutting down")

    # Log

    def info(self, msg: str) -> None:
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        self.get_logger().debug(msg)

    # Shared by the above

    def _start(self, client: ActionClient, goal: Any, what: str) -> bool:
        """Send a goal; return whether it was accepted."""
        if not self._accepted(client, goal, what, self._feedbackCallback):
            return False
        self.result_future = self.goal_handle.get_result_async()
        return True

    def _accepted(
        self,
        client: ActionClient,
        goal: Any,
        what: str,
        on_feedback: Callable[[Any], None] | None = None,
    ) -> bool:
        name = client.action_name.rpartition("/")[2]
        self.debug(f"Waiting for '{name}' action server")
        if not self._wait_for(client.wait_for_server, f"'{name}' action server"):
            return False
        future = client.send_goal_async(goal, on_feedback)
        self._spin_until(future)
        self.goal_handle = future.result()
        if self.goal_handle is None or not self.goal_handle.accepted:
            self.error(f"{what} was rejected!")
            return False
        return True

    def _path(self, client: ActionClient, goal: Any, what: str) -> Path | None:
        """Return the path of an action's result; None unless it succeeded."""
        if not self._accepted(client, goal, what):
            return None
        self.result_future = self.goal_handle.get_result_async()
        self._spin_until(self.result_future)
        response = self.result_future.result()
        if response is None:
            return None
        self.status = response.status
        if self.status != GoalStatus.STATUS_SUCCEEDED:
            reason = getattr(response.result, "error_msg", "")
            self.warn(
                f"{what} failed with status code: {self.status}"
                + (f" ({reason})" if reason else "")
            )
            return None
        path: Path = response.result.path
        return path

    def _call(self, client: Client, request: Any, what: str) -> Any:
        """Return the response of a service, or None after a shutdown."""
        if not self._wait_for(client.wait_for_service, f"{what} service"):
            return None
        future = client.call_async(request)
        self._spin_until(future)
        return future.result()

    def _wait_for(self, ready: Callable[[float], bool], what: str) -> bool:
        """Wait as long as it takes; False after a shutdown."""
        while self.context.ok():
            if ready(_RETRY_S):
                return True
            self.info(f"{what} not available, waiting...")
        return False

    def _spin_until(self, future: "Future[Any]") -> None:
        runtime.spin_until_future_complete(self, future)

    def _manage(self, command: int, doing: str) -> None:
        for name, kinds in self.get_service_names_and_types():
            if _MANAGER in kinds:
                self.info(f"{doing} {name}")
                client = self.create_client(ManageLifecycleNodes, name)
                request = ManageLifecycleNodes.Request(command=command)
                self._call(client, request, name)
                self.destroy_client(client)

    def _waitForNodeToActivate(self, node_name: str) -> None:
        self.debug(f"Waiting for {node_name} to become active..")
        name = f"{node_name}/get_state"
        client = self.create_client(GetState, name)
        state = "unknown"
        while state != "active" and self.context.ok():
            response = self._call(client, GetState.Request(), name)
            state = "unknown" if response is None else response.current_state.label
            self.debug(f"Result of get_state: {state}")
            if state != "active":
                runtime.spin_until_future_complete(self, Future(), timeout_sec=_RETRY_S)
        self.destroy_client(client)

    def _waitForInitialPose(self) -> None:
        while not self.initial_pose_received and self.context.ok():
            self.info("Setting initial pose")
            self._setInitialPose()
            self.info("Waiting for amcl_pose to be received")
            # The whole time, not one callback: time advances in simulated time too.
            self._pose_future = runtime.Future()
            runtime.spin_until_future_complete(
                self, self._pose_future, timeout_sec=_RETRY_S
            )

    def _setInitialPose(self) -> None:
        msg = PoseWithCovarianceStamped(header=self.initial_pose.header)
        msg.pose.pose = self.initial_pose.pose
        self.info("Publishing Initial Pose")
        self.initial_pose_pub.publish(msg)

    def _amclPoseCallback(self, msg: PoseWithCovarianceStamped) -> None:
        self.debug("Received amcl pose")
        self.initial_pose_received = True
        if not self._pose_future.done():
            self._pose_future.set_result(msg)

    def _feedbackCallback(self, msg: Any) -> None:
        self.debug("Received action feedback message")
        self.feedback = msg.feedback


def _span(seconds: float) -> Any:
    return Duration(seconds=float(seconds)).to_msg()
