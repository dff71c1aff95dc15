"""Programs of turtlesim: ``navette run turtlesim turtlesim_node`` and its tutorials."""

import functools
import math
import sys

from navette import runtime
from navette.cli.ros_program import add_live_view, ros_program
from navette.msgs.geometry_msgs.msg import Twist, Vector3
from navette.msgs.std_srvs.srv import Empty, Empty_Request
from navette.msgs.turtlesim.action import RotateAbsolute
from navette.msgs.turtlesim.msg import Pose as TurtlePose
from navette.ros2.turtlesim.node import TurtleSimNode
from navette.runtime import ActionClient, Node, QoSProfile, SingleThreadedExecutor
from navette.runtime.action.client import ClientGoalHandle

_QOS = QoSProfile(depth=7)
_ARROWS = {"up": (1, 0), "down": (-1, 0), "left": (0, 1), "right": (0, -1)}
#: Key → heading, in eighths of a turn: their places around F on the keyboard.
_HEADINGS = {"g": 0, "t": 1, "r": 2, "e": 3, "d": 4, "c": -3, "v": -2, "b": -1}
_SIDE_M = 2.0
#: `--remap __node:=my_turtle` renames the turtles' node only.
_VIEWER_NAME = ("--ros-args", "--remap", "__node:=viewer")


def turtlesim_node() -> None:
    """Run the turtles, with a live view that shows them."""
    with ros_program():
        executor = SingleThreadedExecutor()
        executor.add_node(TurtleSimNode())
        add_live_view(executor, cli_args=_VIEWER_NAME)
        executor.spin()


def turtle_teleop_key() -> None:
    """Drive ``turtle1`` with the keyboard."""
    from navette.cli.keyboard import listening_to_keys

    with ros_program():
        node = _TeleopNode()
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def press(key: str) -> None:
            call = functools.partial(node.press, key)
            node.context.loop.call_soon_threadsafe(call, "key")

        with listening_to_keys(press) as has_keys:
            if not has_keys:
                raise SystemExit("navette: turtle_teleop_key needs a terminal")
            sys.stdout.write(
                "Reading from keyboard\n---------------------------\n"
                "Use arrow keys to move the turtle.\n"
                "Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. "
                "'F' to cancel a rotation.\n'Q' to quit.\n"
            )
            sys.stdout.flush()
            executor.spin_until_future_complete(node.has_quit)


def draw_square() -> None:
    """Drive ``turtle1`` along a square."""
    with ros_program():
        runtime.spin(_SquareNode())


def mimic() -> None:
    """Move a turtle (``output/cmd_vel``) as another does (``input/pose``)."""
    with ros_program():
        node = Node("turtle_mimic")
        commands = node.create_publisher(Twist, "output/cmd_vel", _QOS)
        node.create_subscription(
            TurtlePose,
            "input/pose",
            lambda pose: commands.publish(
                _twist(pose.linear_velocity, pose.angular_velocity)
            ),
            _QOS,
        )
        runtime.spin(node)


class _TeleopNode(Node):
    def __init__(self) -> None:
        super().__init__("teleop_turtle")
        self.declare_parameter("scale_angular", 2.0)
        self.declare_parameter("scale_linear", 2.0)
        self.has_quit: runtime.Future[None] = runtime.Future()
        self._commands = self.create_publisher(Twist, "turtle1/cmd_vel", _QOS)
        self._rotations = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self._goal: ClientGoalHandle | None = None

    def press(self, key: str) -> None:
        key = key.lower()
        if key in _ARROWS:
            forward, turn = _ARROWS[key]
            self._commands.publish(
                _twist(
                    forward * self.get_parameter("scale_linear").value,
                    turn * self.get_parameter("scale_angular").value,
                )
            )
        elif key in _HEADINGS:
            goal = RotateAbsolute.Goal(theta=_HEADINGS[key] * math.pi / 4)
            self._rotations.send_goal_async(goal).add_done_callback(self._keep)
        elif key == "f" and self._goal is not None:
            self._goal.cancel_goal_async()
        elif key == "q" and not self.has_quit.done():
            self.has_quit.set_result(None)

    def _keep(self, future: "runtime.Future[ClientGoalHandle]") -> None:
        self._goal = future.result()


class _SquareNode(Node):
    """Drives forward, stops, turns and stops, by the pose of the turtle."""

    def __init__(self) -> None:
        super().__init__("draw_square")
        self._commands = self.create_publisher(Twist, "turtle1/cmd_vel", _QOS)
        self.create_subscription(TurtlePose, "turtle1/pose", self._on_pose, _QOS)
        self._pose: TurtlePose | None = None
        self._goal: TurtlePose | None = None
        self._is_turning, self._is_stopping = False, False
        client = self.create_client(Empty, "reset")
        client.wait_for_service()
        client.call_async(Empty_Request()).add_done_callback(self._start)

    def _start(self, _: object) -> None:
        self._pose = None
        self.create_timer(0.016, self._step)

    def _on_pose(self, pose: TurtlePose) -> None:
        self._pose = pose

    def _step(self) -> None:
        pose = self._pose
        if pose is None:
            return
        if self._goal is None:
            self._goal = self._next_goal(pose)
        elif self._is_stopping:
            self._commands.publish(_twist(0.0, 0.0))
            if pose.linear_velocity < 1e-4 and abs(pose.angular_velocity) < 1e-4:
                self.get_logger().info("Reached goal")
                self._is_stopping, self._is_turning = False, not self._is_turning
                self._goal = self._next_goal(pose)
        elif self._has_reached(pose, self._goal):
            self._is_stopping = True
        else:
            forward, turn = (0.0, 0.4) if self._is_turning else (1.0, 0.0)
            self._commands.publish(_twist(forward, turn))

    def _next_goal(self, pose: TurtlePose) -> TurtlePose:
        goal = TurtlePose(x=pose.x, y=pose.y, theta=pose.theta)
        if self._is_turning:
            theta = pose.theta + math.pi / 2
            goal.theta = math.atan2(math.sin(theta), math.cos(theta))
        else:
            goal.x += math.cos(pose.theta) * _SIDE_M
            goal.y += math.sin(pose.theta) * _SIDE_M
        text = f"New goal [{goal.x:f} {goal.y:f}, {goal.theta:f}]"
        self.get_logger().info(text)
        return goal

    def _has_reached(self, pose: TurtlePose, goal: TurtlePose) -> bool:
        if self._is_turning:
            return abs(math.remainder(pose.theta - goal.theta, math.tau)) < 0.01
        return math.hypot(pose.x - goal.x, pose.y - goal.y) < 0.1


def _twist(forward: float, turn: float) -> Twist:
    return Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))
