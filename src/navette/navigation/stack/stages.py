"""Each stage as a program of its own: ``navette run navette planner``, and so on.

Several of them, each a process, are the stack that ``navette sim`` runs in one: every
program finds out by itself which robot it is for, takes that robot's parameters, then
those of its command line. A program imports what its own stage needs, no more.
"""

import argparse
import functools
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navette import runtime
from navette.errors import CallbackError, NavetteError
from navette.runtime import Context, ContextClock, Node, PacedClock
from navette.runtime.lockstep import Coordinator
from navette.runtime.overrides import ParameterOverrides

if TYPE_CHECKING:
    from navette.navigation.stack.scene import ResolvedScene


def _program(main: Callable[[], None]) -> Callable[[], None]:
    """What a person got wrong ends the program with one line, not a traceback."""

    @functools.wraps(main)
    def run() -> None:
        try:
            main()
        except CallbackError:
            raise  # a fault in a program: where it is, matters
        except NavetteError as error:
            raise SystemExit(f"navette: {error}") from error

    return run


@_program
def sim() -> None:
    """The simulated robot; at real time, unless told otherwise."""
    parser = _parser("sim", "A robot in a world: takes /cmd_vel, gives sensors.")
    _add_robot(parser)
    parser.add_argument("--start", nargs=3, type=float, metavar=("X", "Y", "YAW_DEG"))
    parser.add_argument(
        "--speed", type=float, metavar="FACTOR", help="times real time, at most"
    )
    _add_conducting(parser)
    given = _parse(parser)
    from navette.geometry import Pose2
    from navette.sim.node import SimNode

    x, y, yaw_deg = given.start or (0.0, 0.0, 0.0)
    start = Pose2(x, y, math.radians(yaw_deg)) if given.start else None
    resolved = _resolve(given)
    _run(
        lambda context: SimNode(resolved.scene, start=start, context=context),
        _profile(resolved, "sim"),
        _clock_of_sim(given),
    )


@_program
def odom_integrator() -> None:
    """The distance travelled."""
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
    )


@_program
def ekf() -> None:
    """Where the robot is, by what its sensors say."""
    from navette.navigation.localization.ekf.node import EkfNode

    text = "odometry, IMU, GNSS, as parameters say → /odom/filtered, /tf"
    _parse(_parser("ekf", text))
    _run(lambda context: EkfNode(context=context), ParameterOverrides())


@_program
def costmap() -> None:
    """What is dangerous around the robot."""
    from navette.navigation.costmap.node import CostmapNode

    _run_stage("costmap", CostmapNode, "/lidar → /costmap")


@_program
def map_memory() -> None:
    """What the robot has seen so far."""
    from navette.navigation.mapping.node import MapMemoryNode

    _run_stage("map_memory", MapMemoryNode, "/costmap, /odom/filtered → /map")


@_program
def planner() -> None:
    """The way to a goal."""
    from navette.navigation.planning.node import PlannerNode

    _run_stage("planner", PlannerNode, "/map, /goal_point → /path")


@_program
def control() -> None:
    """Follows the way; the last stage before the wheels."""
    from navette.navigation.control.node import ControlNode

    _run_stage("control", ControlNode, "/path, /odom/filtered → /cmd_vel")


@_program
def missions() -> None:
    """Sends goals, one after the other; ends with the last of those it was given."""
    parser = _parser("missions", "Goals, one after the other → /goal_point")
    _add_robot(parser)
    parser.add_argument(
        "--goal", nargs=2, type=float, action="append", metavar=("X", "Y")
    )
    given = _parse(parser)
    from navette.navigation.missions.node import MissionNode
    from navette.navigation.missions.sequence import REACHED

    profile = _profile(_resolve(given), "missions")
    if given.goal:
        goals = [value for goal in given.goal for value in goal]
        profile.add("missions", {"goals_m": goals}, "--goal")
    made: list[MissionNode] = []

    def make(context: Context) -> Node:
        node = MissionNode(context=context)
        made.append(node)
        # In lock-step nobody leaves before the simulator does.
        if given.goal and not context.loop.clock.is_shared:
            node.on_done = context.try_shutdown
        return node

    _run(make, profile)
    if made[0].on_done is not None:
        missed = [each for each in made[0].standing if each.result != REACHED]
        for goal in missed:
            x, y = goal.goal
            sys.stderr.write(f"navette: goal ({x:g}, {y:g}): {goal.result}\n")
        raise SystemExit(1 if missed else 0)


@_program
def viewer() -> None:
    """The live view."""
    parser = _parser("viewer", "The live view on one port (parameter port).")
    _add_robot(parser)
    parser.set_defaults(world=None)
    given = _parse(parser)
    own = ParameterOverrides()
    if given.world or given.robot:  # else its frames are ROS 2's usual ones
        given.world = given.world or "arena"
        of_planner = _profile(_resolve(given), "planner").for_node("/planner")
        for name in ("map_frame", "base_frame"):
            if name in of_planner:
                own.add("/**", {name: of_planner[name].value}, of_planner[name].origin)
    _run(_announced_viewer, own)


@_program
def recorder() -> None:
    """Every topic into a bag."""
    parser = _parser("recorder", "Records the topics into a bag.")
    parser.add_argument("file", type=Path, metavar="FILE.mcap")
    given = _parse(parser)
    from navette.bags.node import RecorderNode

    _run(
        lambda context: RecorderNode(given.file, context=context), ParameterOverrides()
    )


def _announced_viewer(context: Context) -> Node:
    from navette.viewer.node import ViewerNode

    node = ViewerNode(context=context)
    node.get_logger().info(f"live view: {node.url}")
    return node


def _run_stage(name: str, node_class: Callable[..., Node], text: str) -> None:
    parser = _parser(name, text)
    _add_robot(parser)
    resolved = _resolve(_parse(parser))
    _run(lambda context: node_class(context=context), _profile(resolved, name))


# -- command lines -----------------------------------------------------------------


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
        help="a built-in world (default: arena) or a file; it may bring a robot",
    )
    parser.add_argument(
        "--robot",
        help="a built-in robot or a model file, whose parameters count; "
        "by default the world's own",
    )


def _add_conducting(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--lockstep",
        metavar="NODE,…",
        help="wait in each step for these nodes of other processes, which run with "
        "NAVETTE_LOCKSTEP=follow; as fast as they can, unless --speed is given",
    )
    for name, default, text in (
        ("step", 0.01, "length of a step"),
        ("until", None, "simulated time at which the run ends for all"),
        ("limit", 30.0, "time that a node may take for a step"),
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


# -- the robot ---------------------------------------------------------------------


def _resolve(given: Any) -> "ResolvedScene":
    from navette.navigation.stack.options import RunOptions
    from navette.navigation.stack.scene import resolve_scene

    return resolve_scene(RunOptions(world=given.world, robot=given.robot or None))


def _profile(resolved: "ResolvedScene", name: str) -> ParameterOverrides:
    """What the robot asks of this node."""
    of_all = ParameterOverrides()
    resolved.override_parameters(of_all)
    return _under_any_name(of_all, name)


def _under_any_name(of_all: ParameterOverrides, name: str) -> ParameterOverrides:
    """What is there for this node, whatever name it is given in the end."""
    own = ParameterOverrides()
    for parameter, override in of_all.for_node(f"/{name}").items():
        own.add("/**", {parameter: override.value}, override.origin)
    return own


def _run(
    make: Callable[[Context], Node],
    profile: ParameterOverrides,
    clock: ContextClock | None = None,
) -> None:
    """Make the node and spin it until Ctrl-C or a shutdown."""
    context = Context(clock=clock)
    context.overrides.sets += profile.sets
    try:
        context.init(args=sys.argv)
        node = make(context)
        context.overrides.check_used_by([node])
        runtime.spin(node)
    except KeyboardInterrupt:
        pass  # the way to end it
    finally:
        context.try_shutdown()
