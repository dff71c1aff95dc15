"""The page as the operator's place, in Chromium: takeover, stop, release, cancel."""

import shutil
from collections.abc import Iterator

import pytest
from test_viewer_javascript import run_node
from viewer_harness import Program

from navette.msgs.geometry_msgs.msg import Point, PointStamped, Twist, Vector3
from navette.msgs.std_msgs.msg import Empty
from navette.navigation.arbiter.node import ArbiterNode
from navette.runtime import Context, Node

pytestmark = pytest.mark.long

TRIES = 20
#: On a machine that runs other tests; the figure is measured by benchmarks/takeover.py.
LATEST_MS = 1000.0


class Robot(Node):
    """Wheels that record commands with the time of day, and a controller."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.commands: list[tuple[float, float, float]] = []  # ms, m/s, rad/s
        self.cancels = self._sent = 0
        self.create_subscription(Twist, "/cmd_vel", self.on_command, 10)
        self.create_subscription(Empty, "/cancel_goal", self.on_cancel, 10)
        self.create_subscription(PointStamped, "/goal_point", lambda goal: None, 10)
        navigation = self.create_publisher(Twist, "/cmd_vel_nav", 10)
        self._goals = self.create_publisher(PointStamped, "/goal_point", 10)
        self._goal_timer = self.create_timer(0.5, self.send_goal)
        ahead = Twist(linear=Vector3(x=0.3))
        self.create_timer(0.05, lambda: navigation.publish(ahead))

    def send_goal(self) -> None:
        """Send a goal four times, once the page receives goals.

        A page that is busy loading is suspended and misses messages.
        """
        if self._goals.get_subscription_count() > 1:
            self._goals.publish(PointStamped(point=Point(x=2.0, y=3.0)))
            self._sent += 1
            if self._sent == 4:
                self._goal_timer.cancel()

    def on_command(self, msg: Twist) -> None:
        self.commands.append(
            (self.get_clock().now_ns / 1e6, msg.linear.x, msg.angular.z)
        )

    def on_cancel(self, msg: Empty) -> None:
        self.cancels += 1

    def after(self, ms: float) -> list[tuple[float, float, float]]:
        return [each for each in self.commands if each[0] >= ms]


@pytest.fixture
def program() -> Iterator[Program]:
    with Program(Robot, lambda context: ArbiterNode(context=context)) as running:
        yield running


@pytest.mark.slow
def test_the_operator_at_the_page(program: Program) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    robot = program.nodes[0]
    assert isinstance(robot, Robot)
    seen = run_node("operator.mjs", program.viewer.url, chromium, str(TRIES))
    assert seen["problems"] == []
    width, height, is_visible = seen["stop"]
    assert is_visible
    assert min(width, height) >= 48  # for a thumb
    assert all(seen["reachable"])
    assert seen["wide"] <= 360
    assert seen["operator"] == "Operator (viewer)"
    assert seen["headline"] == "Driven by operator (viewer)"
    turns = {"ArrowLeft": 0.8, "ArrowRight": -0.8}
    presses = [(turns[key], ms) for key, ms in seen["presses"] if key in turns]
    assert len(presses) == TRIES
    for turn, pressed_ms in presses:
        reached = next(each[0] for each in robot.after(pressed_ms) if each[2] == turn)
        assert reached - pressed_ms < LATEST_MS
    # A lost focus stops the robot, while the key is still held.
    held = [each for each in robot.after(seen["blurred"]) if each[0] < seen["released"]]
    stopped = [each[1:] == (0.0, 0.0) for each in held]
    assert any(stopped)
    assert all(each[1] < 0.5 for each in held[stopped.index(True) :])
    # Space engaged the stop; the key after it had no effect, nor did the button that
    # had the focus.
    assert seen["stopped"] == "Emergency stop"
    space_ms = next(ms for key, ms in seen["presses"] if key == " ")
    (up_ms,) = [ms for key, ms in seen["presses"] if key == "ArrowUp" and ms > space_ms]
    during = [each for each in robot.after(up_ms) if each[0] < up_ms + 600]
    assert {each[1:] for each in during} == {(0.0, 0.0)}
    assert "cancel" not in seen["answer"].lower()
    assert (seen["cancelled"], robot.cancels) == ("Goal cancelled.", 1)
    assert seen["afterText"] == "Navigation"
