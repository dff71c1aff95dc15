"""A robot for tests of tree nodes: calls are recorded, results set by the test."""

from pathlib import Path
from typing import Any

from py_trees.common import Status

from navette.geometry import Pose2
from navette.navigation.missions.tree.behaviour import TreeNode
from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.robot_access import (
    ABORTED,
    SUCCEEDED,
    CallResult,
)
from navette.navigation.missions.tree.tree_file import TreeFile


class ScriptedCall:
    """A call that ends when the test ends it."""

    def __init__(self, name: str, goal: Any) -> None:
        self.name, self.goal = name, goal
        self.result: CallResult | None = None
        self.feedback: Any = None
        self.cancelled = False

    def cancel(self) -> None:
        self.cancelled = True

    def succeed(self, message: Any = None) -> None:
        self.result = CallResult(SUCCEEDED, message)

    def fail(self, message: Any = None, reason: str = "failed") -> None:
        self.result = CallResult(ABORTED, message, reason)


class ScriptedRobot:
    """Implements RobotAccess; time and pose are set by the test."""

    map_frame, base_frame = "map", "base_link"

    def __init__(self) -> None:
        self.now_ns = 0
        self.here: Pose2 | None = Pose2(0.0, 0.0, 0.0)
        self.speed = (0.0, 0.0)
        self.calls: list[ScriptedCall] = []
        self.messages: dict[str, Any] = {}
        self.transforms: set[tuple[str, str]] = set()
        self.is_at_rest = True

    def wait(self, seconds: float) -> None:
        self.now_ns += round(seconds * 1e9)

    def pose(self) -> Pose2 | None:
        return self.here

    def velocity(self) -> tuple[float, float]:
        return self.speed

    def has_transform(self, target: str, source: str) -> bool:
        return (target, source) in self.transforms

    def navigate(self, goal: Any) -> ScriptedCall:
        return self._call("navigate", goal)

    def driven_path(self, distance_m: float) -> Any:
        return self.messages.get("driven")

    def start_action(self, action_type: str, name: str, goal: Any) -> ScriptedCall:
        return self._call(name, goal)

    def call_service(self, service_type: str, name: str, request: Any) -> ScriptedCall:
        return self._call(name, request)

    def cancel_all(self, action_type: str, name: str) -> ScriptedCall:
        return self._call(f"cancel {name}", None)

    def newest(self, topic: str, message_type: str, *, latched: bool = False) -> Any:
        return self.messages.get(topic)

    def _call(self, name: str, goal: Any) -> ScriptedCall:
        call = ScriptedCall(name, goal)
        self.calls.append(call)
        return call

    @property
    def names(self) -> list[str]:
        return [call.name for call in self.calls]


class Planted:
    """A tree built from XML, with its robot and blackboard."""

    def __init__(self, folder: Path, text: str, **entries: Any) -> None:
        self.path = folder / "tree.xml"
        self.path.write_text(
            '<root BTCPP_format="4" main_tree_to_execute="Main">\n'
            f'<BehaviorTree ID="Main">\n{text}\n</BehaviorTree>\n</root>\n'
        )
        self.robot = ScriptedRobot()
        self.board = TreeBlackboard()
        for name, value in entries.items():
            self.board.set(name, value)
        self.root: TreeNode = TreeFile.read(self.path).build(self.robot, self.board)

    def tick(self, seconds: float = 0.0) -> Status:
        self.robot.wait(seconds)
        self.root.tick_once()
        return self.root.status

    def halt(self) -> None:
        self.root.stop(Status.INVALID)
