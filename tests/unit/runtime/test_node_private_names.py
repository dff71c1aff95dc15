"""Private names of nodes: none that a derived class may use for its own."""

from navette.runtime import Node
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
