"""Corrections of map → odom while the robot drives."""

import math

from navette.geometry import Pose2, Transform3
from navette.geometry.messages import transform_message
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.stack import NavigationStack
from navette.runtime import Context, Executor, Node, VirtualClock
from navette.sim import Scene, World
from navette.sim.node import SimNode

GOAL = (7.0, 1.0)


class Corrector(Node):
    """Publishes map → odom: wrong by ``error`` until ``until_s``, then right."""

    def __init__(self, error: Pose2, until_s: float, context: Context) -> None:
        super().__init__("corrector", context=context)
        self._error, self._until_ns = error, round(until_s * 1e9)
        self._publisher = self.create_publisher(TFMessage, "/tf", 10)
        self.create_timer(0.05, self._publish)

    def _publish(self) -> None:
        now_ns = self.get_clock().now_ns
        pose = self._error if now_ns < self._until_ns else Pose2(0.0, 0.0, 0.0)
        transform = transform_message(
            now_ns, "map", "odom", Transform3.from_pose2(pose)
        )
        self._publisher.publish(TFMessage(transforms=[transform]))


def hall() -> Scene:
    world = World("hall").add_box((3.0, 0.3), (0.5, 0.8))
    for side in (-4.0, 4.0):
        world = world.add_box((3.0, side), (14.0, 0.2))
    return world.scene()


def drive(error: Pose2, until_s: float) -> tuple[list[str], set[str], float, int]:
    """Return results, states of the controller, distance from the goal, contacts."""
    resolved = resolve_scene(RunOptions(world="empty", robot="jackal"), hall())
    context = Context(clock=VirtualClock())
    with context:
        resolved.override_parameters(context.overrides)
        context.overrides.add("missions", {"goals_m": list(GOAL)}, "test")
        # Wheel odometry without noise: the correction is the only error.
        exact = {"localization": "amcl+wheels", "wheel_noise_m": 0.0}
        context.overrides.add("sim", exact, "test")
        sim = SimNode(resolved.scene, start=Pose2(0.0, 0.0, 0.0), context=context)
        Corrector(error, until_s, context)
        stack = NavigationStack.create(context)
        states: set[str] = set()
        watcher = Node("watcher", context=context)
        watcher.create_subscription(
            DiagnosticStatus, "/control/status", lambda m: states.add(m.message), 10
        )
        executor = Executor(context=context)
        for node in context.nodes:
            executor.add_node(node)
        stack.missions.on_done = executor.stop
        executor.spin_until(60_000_000_000)
        x, y, _ = sim.simulator.pose().translation
        results = [each.result for each in stack.missions.all_outcomes]
        return results, states, math.dist((x, y), GOAL), sim.simulator.contacts.count


def test_a_jump_to_the_side_is_driven_through() -> None:
    results, states, missed_m, contacts = drive(Pose2(0.0, 0.5, 0.0), 3.0)
    assert results == ["reached"]
    assert contacts == 0
    assert missed_m < 0.6
    assert not states & {"off_path", "stalled", "missed_goal"}


def test_a_jump_that_turns_the_map_is_driven_through() -> None:
    results, states, missed_m, contacts = drive(Pose2(0.3, -0.3, 0.35), 3.0)
    assert results == ["reached"]
    assert contacts == 0
    assert missed_m < 0.6
    assert not states & {"off_path", "stalled", "missed_goal"}
