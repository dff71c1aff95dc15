"""Each stage as a program: ``navette run navette planner``, and so on.

Together these processes form the stack that ``navette sim`` runs in one process. Every
program loads the parameters of its robot, then those of its command line. A program
imports only the modules of its own stage.
"""

import argparse
import functools
import math
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navette import runtime
from navette.errors import CallbackError, NavetteError
from navette.files.runs import stay_shared
from navette.navigation.stack.stage_classes import node_class
from navette.runtime import Context, ContextClock, Node, PacedClock
from navette.runtime.lockstep import Coordinator
from navette.runtime.overrides import ParameterOverrides

if TYPE_CHECKING:
    from navette.geometry import Pose2
    from navette.navigation.stack.scene import ResolvedScene
    from navette.sim.params import SimParams


# Held by the stage of this process that starts: modules of one package that two threads
# import at once may fail with Python's import deadlock.
_starting = threading.Lock()


@contextmanager
def _others_may_start() -> Iterator[None]:
    _starting.release()
    try:
        yield
    finally:
        _starting.acquire()


def _program(main: Callable[[], None]) -> Callable[[], None]:
    """Start one stage at a time; report user errors in one line, not a traceback."""

    @functools.wraps(main)
    def run() -> None:
        try:
            with _starting:
                main()
        except CallbackError:
            raise  # a fault in the program: show its traceback
        except NavetteError as error:
            raise SystemExit(f"navette: {error}") from error

    return run


@_program
def sim() -> None:
    """Run the simulated robot, in real time by default."""
    parser = _parser(
        "sim", "A robot in a world: subscribes to /cmd_vel, publishes sensors."
    )
    _add_robot(parser)
    _add_start(parser)
    parser.add_argument(
        "--speed", type=float, metavar="FACTOR", help="limit as a multiple of real time"
    )
    _add_lockstep(parser)
    given = _parse(parser)
    from navette.sim.node import SimNode

    resolved = _resolve(given)
    _run(
        lambda context: SimNode(resolved.scene, start=given.start, context=context),
        _profile(resolved, "sim"),
        _clock_of_sim(given),
        resolved=resolved,
    )


@_program
def odom_integrator() -> None:
    """Run the odom_integrator node."""
    from navette.navigation.localization.distance.node import OdomIntegratorNode

    text = "positions or velocities → /odom_integrator/distance"
    _parse(_parser("odom_integrator", text))
    navigation = Path(__file__).parents[1]
    config = navigation / "localization/config/odom_integrator.yaml"
    of_all = ParameterOverrides()
    of_all.add_file(config)
    _run(
        lambda context: OdomIntegratorNode(context=context),
        _under_any_name(of_all, "odom_integrator"),
        joins_run=True,
    )


@_program
def ekf() -> None:
    """Run the extended Kalman filter."""
    text = "odometry, IMU, GNSS (topics are parameters) → /odom/filtered, /tf"
    parser = _parser("ekf", text)
    _add_robot(parser)
    parser.add_argument(
        "--localization",
        metavar="SOURCE",
        help="fuse the sensors of the simulated robot for this --localization",
    )
    given = _parse(parser)
    if given.localization is None:
        _run(lambda context: _make("ekf", context), ParameterOverrides())
    else:
        sim = _simulated(given, given.localization)
        _run_localization(given, sim, ["ekf"], None)


@_program
def localization() -> None:
    """Run the nodes that locate the simulated robot."""
    from navette.navigation.stack.localization import localization_nodes

    text = "the nodes of --localization (localizer, ekf, slam, amcl), in one process"
    parser = _locating_parser("localization", text)
    parser.add_argument(
        "--localization",
        metavar="SOURCE",
        default="truth",
        help="as for navette sim: truth, odometry, slam or amcl, with +SENSOR "
        "(default: %(default)s)",
    )
    given = _parse(parser)
    sim = _simulated(given, given.localization)
    model = _resolve(given).scene.robot
    start = given.start or (model.world_T_model.to_pose2() if model else None)
    _run_localization(given, sim, localization_nodes(sim), start)


@_program
def localizer() -> None:
    """Run the localizer."""
    _run_stage("localizer", "/odom/filtered, /initialpose → /amcl_pose")


@_program
def amcl() -> None:
    """Run the localization on a known map."""
    text = "/static_map, /lidar, /odom/filtered → /tf (map → odom), /amcl_pose"
    given = _parse(_locating_parser("amcl", text))
    sim = _simulated(given, "amcl")
    _run_localization(given, sim, ["amcl"], given.start)


@_program
def slam() -> None:
    """Run the SLAM."""
    text = "/lidar, /odom/filtered → /tf (map → odom), /pose, /slam/map"
    given = _parse(_locating_parser("slam", text))
    sim = _simulated(given, "slam")
    _run_localization(given, sim, ["slam"], given.start)


@_program
def costmap() -> None:
    """Run the costmap."""
    _run_stage("costmap", "/lidar → /costmap")


@_program
def tracking() -> None:
    """Run the tracking of moving obstacles."""
    _run_stage("tracking", "/lidar, /odom/filtered → /tracked_obstacles")


@_program
def map_memory() -> None:
    """Run the map memory."""
    _run_stage("map_memory", "/costmap, /odom/filtered → /map")


@_program
def zones() -> None:
    """Run the keep-out and speed zones."""
    _run_stage("zones", "filter masks → /keepout_zones, /speed_limit")


@_program
def planner() -> None:
    """Run the planner."""
    _run_stage("planner", "/map, /goal_point → /path")


@_program
def control() -> None:
    """Run the controller."""
    _run_stage("control", "/path, /odom/filtered → /cmd_vel_nav")


@_program
def behaviors() -> None:
    """Run the behaviors."""
    text = "actions spin, backup, drive_on_heading, … → /cmd_vel_nav"
    _run_stage("behaviors", text)


@_program
def reflex() -> None:
    """Run the reflex to contacts."""
    _run_stage("reflex", "/hazard_detection → /cmd_vel_reflex")


@_program
def arbiter() -> None:
    """Run the arbiter."""
    text = "/cmd_vel_nav, /cmd_vel_teleop, /emergency_stop → /cmd_vel"
    _run_stage("arbiter", text)


@_program
def lifecycle_manager() -> None:
    """Run the lifecycle manager."""
    from navette.navigation.servers.lifecycle_manager import LifecycleManagerNode

    text = "services that start, pause and stop the navigation nodes"
    _parse(_parser("lifecycle_manager", text))
    _run(lambda context: LifecycleManagerNode(context=context), ParameterOverrides())


@_program
def missions() -> None:
    """Send goals, one after another; with --goal, end after the last."""
    parser = _parser("missions", "Goals, one after another → /goal_point")
    _add_robot(parser)
    parser.add_argument(
        "--goal", nargs=2, type=float, action="append", metavar=("X", "Y")
    )
    parser.add_argument(
        "--tree", metavar="FILE", help="the behaviour tree of navigate_to_pose"
    )
    given = _parse(parser)
    from navette.navigation.missions.node import MissionNode
    from navette.navigation.missions.sequence import REACHED

    resolved = _resolve_robot(given)
    profile = _profile(resolved, "missions")
    if given.goal:
        goals = [value for goal in given.goal for value in goal]
        profile.add("/**", {"goals_m": goals}, "--goal")
    if given.tree:
        profile.add("/**", {"default_nav_to_pose_bt_xml": given.tree}, "--tree")
    made: list[MissionNode] = []

    def make(context: Context) -> Node:
        node = MissionNode(context=context)
        made.append(node)
        # In lock-step all participants run until the simulator ends.
        if given.goal and not context.loop.clock.is_shared:
            node.on_done = context.try_shutdown
        return node

    _run(make, profile, resolved=resolved)
    if made[0].on_done is not None:
        missed = [each for each in made[0].all_outcomes if each.result != REACHED]
        for goal in missed:
            x, y = goal.goal
            sys.stderr.write(f"navette: goal ({x:g}, {y:g}): {goal.result}\n")
        raise SystemExit(1 if missed else 0)


@_program
def explorer() -> None:
    """Run the explorer."""
    _run_stage("explorer", "/map → goals of navigate_to_pose")


@_program
def viewer() -> None:
    """Run the live view."""
    parser = _parser("viewer", "The live view on one port (parameter port).")
    _add_robot(parser)
    parser.set_defaults(world=None)
    given = _parse(parser)
    own = ParameterOverrides()
    if given.world or given.robot:  # otherwise its frames are ROS 2's usual ones
        given.world = given.world or "arena"
        of_planner = _profile(_resolve(given), "planner").for_node("/planner")
        for name in ("map_frame", "base_frame"):
            if name in of_planner:
                own.add("/**", {name: of_planner[name].value}, of_planner[name].origin)
    _run(_announced_viewer, own, joins_run=True)


@_program
def recorder() -> None:
    """Record every topic in a bag."""
    parser = _parser("recorder", "Records the topics into a bag.")
    parser.add_argument("file", type=Path, metavar="FILE.mcap")
    parser.add_argument(
        "--overwrite", action="store_true", help="replace an existing recording"
    )
    given = _parse(parser)
    from navette.bags.node import RecorderNode

    _run(
        lambda context: RecorderNode(
            given.file, overwrite=given.overwrite, context=context
        ),
        ParameterOverrides(),
    )


def _announced_viewer(context: Context) -> Node:
    from navette.viewer.node import ViewerNode

    node = ViewerNode(context=context)
    node.get_logger().info(f"live view: {node.url}")
    if node.remote_url:  # with the token: log messages are published and recorded
        sys.stderr.write(f"live view for other machines: {node.remote_url}\n")
    return node


def _run_stage(name: str, text: str) -> None:
    parser = _parser(name, text)
    _add_robot(parser)
    resolved = _resolve_robot(_parse(parser))
    _run(
        lambda context: _make(name, context),
        _profile(resolved, name),
        resolved=resolved,
    )


def _locating_parser(name: str, text: str) -> argparse.ArgumentParser:
    parser = _parser(name, text)
    _add_robot(parser)
    _add_start(parser)
    return parser


def _simulated(given: Any, localization: str) -> "SimParams":
    """Return the parameters of the simulated robot: its frames, and the source."""
    from navette.sim.params import SimParams

    of_sim = _profile(_resolve_robot(given), "sim").for_node("/sim")
    frames = {
        frame: of_sim[frame].value
        for frame in ("map_frame", "odom_frame", "base_frame")
        if frame in of_sim
    }
    return SimParams(localization=localization, **frames)


def _run_localization(
    given: Any,
    sim: "SimParams",
    nodes: Sequence[str],
    start: "Pose2 | None",
) -> None:
    """Run nodes that locate the robot, with the frames of the robot.

    Args:
        start: pose of the robot at the start; None: not known.
    """
    from navette.geometry import Pose2
    from navette.navigation.stack.localization_params import localization_parameters

    resolved = _resolve(given)
    of_nodes = localization_parameters(
        sim, start or Pose2(0.0, 0.0, 0.0), resolved.scene.origin
    )
    profile = ParameterOverrides()
    for name in nodes:
        own = of_nodes.get(name, {})
        if start is None:
            own = {key: v for key, v in own.items() if "initial_pose" not in key}
        # A single node may be given any name.
        target = "/**" if len(nodes) == 1 else f"/{name}"
        profile.add(target, own, "frames of the robot")
        profile.sets += _profile(resolved, name, target).sets

    def make(context: Context) -> Node:
        return [_make(name, context) for name in nodes][-1]

    _run(make, profile, resolved=resolved)


def _make(name: str, context: Context) -> Node:
    kind: Callable[..., Node] = node_class(name)
    return kind(context=context)


def _parser(name: str, text: str) -> argparse.ArgumentParser:
    return argparse.ArgumentParser(
        f"navette run navette {name}",
        description=text,
        epilog="Parameters: --ros-args -p NAME:=VALUE --params-file FILE.",
        allow_abbrev=False,
    )


def _add_robot(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--world",
        default="arena",
        help="a built-in world (default: arena), a file, which may contain a robot, or "
        "a generated world such as rooms:3",
    )
    parser.add_argument(
        "--robot",
        help="a built-in robot or a model file, whose parameters are used "
        "(default: the world's own robot)",
    )
    parser.add_argument(
        "--sensor",
        action="append",
        default=[],
        metavar="TYPE[@PLACE]",
        help="a sensor on the robot, as for navette sim; several: repeated, or with "
        "commas between",
    )


def _add_start(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--start",
        nargs=3,
        type=float,
        action=_PoseAction,
        metavar=("X", "Y", "YAW_DEG"),
        help="pose of the robot at the start",
    )


class _PoseAction(argparse.Action):
    """Store x, y (m) and yaw (degrees) as a pose."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        from navette.geometry import Pose2

        x, y, yaw_deg = values
        setattr(namespace, self.dest, Pose2(x, y, math.radians(yaw_deg)))


def _add_lockstep(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--lockstep",
        metavar="NODE,…",
        help="wait in each step for these nodes of other processes, which run with "
        "NAVETTE_LOCKSTEP=follow; as fast as possible unless --speed is given",
    )
    for name, default, text in (
        ("step", 0.01, "length of a step"),
        ("until", None, "simulated time at which the run ends for all"),
        ("limit", 30.0, "longest time of a node for a step"),
    ):
        parser.add_argument(
            f"--lockstep-{name}",
            type=float,
            default=default,
            metavar="SECONDS",
            help=text + ("" if default is None else " (default: %(default)s s)"),
        )


def _clock_of_sim(given: Any) -> ContextClock:
    if given.lockstep is None:
        return PacedClock(1.0 if given.speed is None else given.speed)
    return Coordinator(
        given.lockstep.split(","),
        step_s=given.lockstep_step,
        speed=math.inf if given.speed is None else given.speed,
        until_s=given.lockstep_until,
        limit_s=given.lockstep_limit,
    )


def _parse(parser: argparse.ArgumentParser) -> Any:
    return parser.parse_args(runtime.remove_ros_args(sys.argv[1:]))


def _resolve_robot(given: Any) -> "ResolvedScene":
    """Return the robot; the world is read only if it has the robot."""
    return _resolve(given, world="empty" if given.robot else given.world)


def _resolve(given: Any, world: str | None = None) -> "ResolvedScene":
    from navette.navigation.stack.options import RunOptions
    from navette.navigation.stack.scene import resolve_scene

    return resolve_scene(
        RunOptions(
            world=given.world if world is None else world,
            robot=given.robot or None,
            sensors=tuple(filter(None, ",".join(given.sensor).split(","))),
        )
    )


def _profile(
    resolved: "ResolvedScene", name: str, target: str = "/**"
) -> ParameterOverrides:
    """Return the robot's parameters of this node."""
    of_all = ParameterOverrides()
    resolved.override_parameters(of_all)
    return _under_any_name(of_all, name, target)


def _under_any_name(
    of_all: ParameterOverrides, name: str, target: str = "/**"
) -> ParameterOverrides:
    """Return the parameters of this node for any name it may be given."""
    own = ParameterOverrides()
    for parameter, override in of_all.for_node(f"/{name}").items():
        own.add(target, {parameter: override.value}, override.origin)
    return own


def _run(
    make: Callable[[Context], Node],
    profile: ParameterOverrides,
    clock: ContextClock | None = None,
    *,
    resolved: "ResolvedScene | None" = None,
    joins_run: bool = False,
) -> None:
    """Create the node and spin it until Ctrl-C or a shutdown.

    Args:
        resolved: the robot whose topic names are used.
        joins_run: join the only private run; False: most stages are in it already, and
            a second one would disturb its robot.
    """
    if not joins_run:
        stay_shared()
    context = Context(clock=clock)
    context.overrides.sets += profile.sets
    try:
        with _others_may_start():
            context.init(args=sys.argv)
        if resolved is not None:
            resolved.rename_topics(context)
        node = make(context)
        context.overrides.check_used_by(context.nodes)
        for other in context.nodes:
            runtime.get_global_executor(context).add_node(other)
        with _others_may_start():
            runtime.spin(node)
    except KeyboardInterrupt:
        pass  # the usual end
    finally:
        context.try_shutdown()
