"""Node ``turtlesim``: topics, services and actions of turtlesim's turtles.

Source: ROS 2's package turtlesim, whose interfaces, constants and order of work these
are. The canvas is published as markers instead of a window.
"""

import math
from collections.abc import Callable
from typing import Any

from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from navette.msgs.std_srvs.srv import Empty, Empty_Request, Empty_Response
from navette.msgs.turtlesim.action import RotateAbsolute
from navette.msgs.turtlesim.msg import Color
from navette.msgs.turtlesim.msg import Pose as TurtlePose
from navette.msgs.turtlesim.srv import (
    Kill,
    Kill_Request,
    Kill_Response,
    SetPen,
    SetPen_Request,
    SetPen_Response,
    Spawn,
    Spawn_Request,
    Spawn_Response,
    TeleportAbsolute,
    TeleportAbsolute_Request,
    TeleportAbsolute_Response,
    TeleportRelative,
    TeleportRelative_Request,
    TeleportRelative_Response,
)
from navette.msgs.visualization_msgs.msg import MarkerArray
from navette.ros2.turtlesim.drawing import canvas_markers, turtle_markers
from navette.ros2.turtlesim.turtle import SIDE_M, Canvas, Pen, Turtle, normalized
from navette.runtime import (
    ActionServer,
    CancelResponse,
    Context,
    DurabilityPolicy,
    Future,
    Node,
    QoSProfile,
)
from navette.runtime.action.server_goal_handle import ServerGoalHandle

_PERIOD_S = 0.016
#: Steps between two messages of the canvas; its lines grow.
_CANVAS_STEPS = 15
_QOS = QoSProfile(depth=7)
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_BACKGROUND = {"background_r": 0x45, "background_g": 0x56, "background_b": 0xFF}


class TurtleSimNode(Node):
    """Owns the canvas and the turtles, the first of which is ``turtle1``."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__("turtlesim", context=context)
        for name, value in _BACKGROUND.items():
            channel = {"r": "Red", "g": "Green", "b": "Blue"}[name[-1]]
            self.declare_parameter(
                name,
                value,
                ParameterDescriptor(
                    description=f"{channel} channel of the background color",
                    integer_range=[IntegerRange(from_value=0, to_value=255, step=1)],
                ),
            )
        self.declare_parameter(
            "holonomic",
            False,
            ParameterDescriptor(description="If true, then turtles will be holonomic"),
        )
        self._canvas = Canvas()
        self._turtles: dict[str, _TurtleEntities] = {}
        self._number, self._step = 0, 0
        self._turtle_markers = self.create_publisher(MarkerArray, "~/turtles", _LATCHED)
        self._canvas_markers = self.create_publisher(MarkerArray, "~/canvas", _LATCHED)
        self.create_service(Empty, "clear", self._clear)
        self.create_service(Empty, "reset", self._reset)
        self.create_service(Spawn, "spawn", self._on_spawn)
        self.create_service(Kill, "kill", self._kill)
        name = self.get_fully_qualified_name()
        self.get_logger().info(f"Starting turtlesim with node name {name}")
        self._spawn("", SIDE_M / 2, SIDE_M / 2, 0.0)
        self.create_timer(_PERIOD_S, self._update)

    @property
    def turtles(self) -> list[Turtle]:
        return [each.turtle for each in self._turtles.values()]

    def _update(self) -> None:
        for each in list(self._turtles.values()):
            each.update(self._canvas)
        stamp = self.get_clock().now().to_msg()
        self._turtle_markers.publish(turtle_markers(self.turtles, stamp))
        if self._step % _CANVAS_STEPS == 0:
            r, g, b = (int(self.get_parameter(name).value) for name in _BACKGROUND)
            strokes = self._canvas.strokes
            self._canvas_markers.publish(canvas_markers((r, g, b), strokes, stamp))
        self._step += 1

    def _spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Return the name of a new turtle; "" if the name is taken."""
        while not name:
            self._number += 1
            numbered = f"turtle{self._number}"
            name = "" if numbered in self._turtles else numbered
        if name in self._turtles:
            return ""
        self._turtles[name] = _TurtleEntities(self, Turtle(name, x, y, theta))
        self.get_logger().info(
            f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]"
        )
        return name

    def _on_spawn(
        self, request: Spawn_Request, response: Spawn_Response
    ) -> Spawn_Response:
        response.name = self._spawn(request.name, request.x, request.y, request.theta)
        if not response.name:
            self.get_logger().error(f"A turtle named [{request.name}] already exists")
        return response

    def _kill(self, request: Kill_Request, response: Kill_Response) -> Kill_Response:
        killed = self._turtles.pop(request.name, None)
        if killed is None:
            self.get_logger().error(
                f"Tried to kill turtle [{request.name}], which does not exist"
            )
        else:
            killed.destroy()
        return response

    def _clear(self, _: Empty_Request, response: Empty_Response) -> Empty_Response:
        self.get_logger().info("Clearing turtlesim.")
        self._canvas.clear()
        for turtle in self.turtles:
            turtle.forget_line()
        return response

    def _reset(self, _: Empty_Request, response: Empty_Response) -> Empty_Response:
        self.get_logger().info("Resetting turtlesim.")
        for each in self._turtles.values():
            each.destroy()
        self._turtles.clear()
        self._number = 0
        self._canvas.clear()
        self._spawn("", SIDE_M / 2, SIDE_M / 2, 0.0)
        return response


class _TurtleEntities:
    """A turtle with its topics, services and action."""

    def __init__(self, node: Node, turtle: Turtle) -> None:
        self.turtle = turtle
        self._node = node

        def own(name: str) -> str:
            return f"{turtle.name}/{name}"

        self._pose = node.create_publisher(TurtlePose, own("pose"), _QOS)
        self._colour = node.create_publisher(Color, own("color_sensor"), _QOS)
        self._teleports: list[Callable[[Canvas], None]] = []
        self._rotation: _Rotation | None = None
        self._subscription = node.create_subscription(
            Twist, own("cmd_vel"), self._on_command, _QOS
        )
        self._services = [
            node.create_service(kind, own(verb), answer)
            for kind, verb, answer in (
                (SetPen, "set_pen", self._set_pen),
                (TeleportRelative, "teleport_relative", self._teleport_relative),
                (TeleportAbsolute, "teleport_absolute", self._teleport_absolute),
            )
        ]
        self._action = ActionServer(
            node,
            RotateAbsolute,
            own("rotate_absolute"),
            execute_callback=self._rotate,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def destroy(self) -> None:
        self._end_rotation("abort")
        self._action.destroy()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._pose)
        self._node.destroy_publisher(self._colour)

    def update(self, canvas: Canvas) -> None:
        """Do what was requested, move, and publish."""
        for teleport in self._teleports:
            teleport(canvas)
        self._teleports.clear()
        self._continue_rotation()
        turtle = self.turtle
        turtle.step(_PERIOD_S, canvas)
        if turtle.hit_wall:
            self._node.get_logger().warning(
                f"Oh no! I hit the wall! (Clamping to [x={turtle.x:f}, y={turtle.y:f}])"
            )
        self._pose.publish(
            TurtlePose(
                x=turtle.x,
                y=turtle.y,
                theta=turtle.theta,
                linear_velocity=turtle.speed,
                angular_velocity=turtle.velocity[2],
            )
        )
        r, g, b = canvas.colour_at(turtle.x, turtle.y)
        self._colour.publish(Color(r=r, g=g, b=b))

    def _on_command(self, twist: Twist) -> None:
        is_holonomic = bool(self._node.get_parameter("holonomic").value)
        left = twist.linear.y if is_holonomic else 0.0
        self.turtle.command(twist.linear.x, left, twist.angular.z)
        if self._rotation is not None:
            self._node.get_logger().warning(
                "Velocity command received during rotation goal. Aborting goal"
            )
            self._end_rotation("abort")

    def _set_pen(
        self, request: SetPen_Request, response: SetPen_Response
    ) -> SetPen_Response:
        if request.off:
            pen = Pen(self.turtle.pen.colour, self.turtle.pen.width_px, is_off=True)
        else:
            colour = request.r, request.g, request.b
            pen = Pen(colour, request.width or 1)
        self.turtle.set_pen(pen)
        return response

    def _teleport_relative(
        self, request: TeleportRelative_Request, response: TeleportRelative_Response
    ) -> TeleportRelative_Response:
        def teleport(canvas: Canvas) -> None:
            turtle = self.turtle
            theta = turtle.theta + request.angular
            x = turtle.x + math.cos(theta) * request.linear
            y = turtle.y + math.sin(theta) * request.linear
            turtle.teleport(x, y, theta, canvas)

        self._teleports.append(teleport)
        return response

    def _teleport_absolute(
        self, request: TeleportAbsolute_Request, response: TeleportAbsolute_Response
    ) -> TeleportAbsolute_Response:
        self._teleports.append(
            lambda canvas: self.turtle.teleport(
                request.x, request.y, request.theta, canvas
            )
        )
        return response

    async def _rotate(self, goal: ServerGoalHandle) -> Any:
        if self._rotation is not None:
            self._node.get_logger().warning(
                "Rotation goal received before a previous goal finished. "
                "Aborting previous goal"
            )
            self._end_rotation("abort")
        rotation = self._rotation = _Rotation(goal, self.turtle.theta)
        result = RotateAbsolute.Result(delta=await rotation.delta or 0.0)
        {"succeed": goal.succeed, "abort": goal.abort, "canceled": goal.canceled}[
            rotation.end
        ]()
        return result

    def _continue_rotation(self) -> None:
        rotation = self._rotation
        if rotation is None:
            return
        if rotation.goal.is_cancel_requested:
            self._node.get_logger().info("Rotation goal canceled")
            self.turtle.command(0.0, 0.0, 0.0)
            self._end_rotation("canceled")
            return
        remaining = self.turtle.turn_towards(rotation.goal.request.theta)
        rotation.goal.publish_feedback(RotateAbsolute.Feedback(remaining=remaining))
        if remaining == 0.0:
            self._node.get_logger().info("Rotation goal completed successfully")
            self._end_rotation("succeed")

    def _end_rotation(self, end: str) -> None:
        rotation, self._rotation = self._rotation, None
        if rotation is not None:
            rotation.end = end
            rotation.delta.set_result(normalized(rotation.start - self.turtle.theta))


class _Rotation:
    """A goal of rotate_absolute that is being worked on."""

    def __init__(self, goal: ServerGoalHandle, start: float) -> None:
        self.goal, self.start = goal, start
        self.end = ""
        self.delta: Future[float] = Future()
