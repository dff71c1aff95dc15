"""Names of nodes and executors: none that a derived class may use for its own."""

from typing import Any

import pytest

from navette.msgs.std_srvs.srv import Trigger
from navette.runtime import Node, SingleThreadedExecutor
from navette.runtime.lifecycle import LifecycleNode
from navette.runtime.testing import GraphHarness

#: Names of rclpy's Node, which derived classes avoid on ROS 2 as well.
_OF_RCLPY = {
    "_clock",
    "_context",
    "_logger",
    "_managed_entities",
    "_parameter_service",
    "_state_machine",
    "_time_source",
    "_type_description_service",
}


def test_private_names_have_a_prefix_or_are_those_of_rclpy(graph: GraphHarness) -> None:
    node = LifecycleNode("n", context=graph.context)
    names = {*vars(node), *(n for kind in LifecycleNode.__mro__ for n in vars(kind))}
    own = {n for n in names if n.startswith("_") and not n.startswith("__")}
    prefixes = ("_node_", "_lifecycle_", "_abc_", "_Node__", "_HasHandle__")
    assert {n for n in own if not n.startswith(prefixes)} - _OF_RCLPY == set()


def test_a_derived_class_has_names_of_its_own(graph: GraphHarness) -> None:
    class Robot(Node):
        def __init__(self) -> None:
            self._executor = self._info = self._store = "mine"
            super().__init__("robot", context=graph.context)
            self._overrides = self._remapper = self._known = "mine"

        def _declare(self) -> None: ...

        def _on_topic(self) -> None: ...

    robot = Robot()
    assert robot.declare_parameter("speed", 1.0).value == 1.0
    assert robot.get_publishers_info_by_topic("chatter") == []
    assert robot.executor is None
    assert (robot._executor, robot._info, robot._store) == ("mine",) * 3


def test_a_derived_class_has_methods_of_its_own(graph: GraphHarness) -> None:
    class Gripper(Node):
        def __init__(self) -> None:
            super().__init__("gripper", context=graph.context)
            self.create_service(Trigger, "grip", self.serve)
            self.held: list[str] = []

        def attach(self, name: str) -> None:
            self.held.append(name)

        def detach(self, name: str) -> None:
            self.held.remove(name)

        def serve(self, request: Any, response: Any) -> Any:
            self.attach("box")
            return response

        def known_parameters(self, prefix: str) -> list[str]:
            return [prefix]

    gripper = graph.add(Gripper())
    graph.call(Trigger, "/grip", Trigger.Request())
    assert gripper.held == ["box"]
    assert gripper.executor is not None
    gripper.executor.remove_node(gripper)
    assert gripper.executor is None


def test_a_derived_executor_has_a_stop_of_its_own(graph: GraphHarness) -> None:
    class Reasoned(SingleThreadedExecutor):
        def stop(self, why: str) -> None:  # type: ignore[override]
            pytest.fail(why)

    executor = Reasoned(context=graph.context)
    assert executor.shutdown()
