"""Exceptions that programs catch by rclpy's classes."""

from pathlib import Path

import pytest

from navette.msgs.std_msgs.msg import String
from navette.runtime import Context, Node, QoSProfile
from navette.runtime.exceptions import (
    InvalidHandle,
    InvalidParameterTypeException,
    RCLError,
)
from navette.runtime.testing import GraphHarness


def test_an_override_of_another_type(graph: GraphHarness) -> None:
    node = Node("n", context=graph.context, cli_args=["--ros-args", "-p", "s:=true"])
    with pytest.raises(InvalidParameterTypeException, match="expected STRING"):
        node.declare_parameter("s", "text")


@pytest.mark.parametrize("text", [None, "n:\n\tros__parameters:\n"])
def test_a_parameter_file_that_cannot_be_read(tmp_path: Path, text: str | None) -> None:
    file = tmp_path / "p.yaml"
    if text is not None:
        file.write_text(text)
    with pytest.raises(RCLError, match=r"p\.yaml"):
        Context().init(args=["program", "--ros-args", "--params-file", str(file)])


def test_use_of_a_destroyed_node(graph: GraphHarness) -> None:
    node = Node("gone", context=graph.context)
    node.destroy_node()
    with pytest.raises(InvalidHandle, match="/gone was destroyed"):
        node.create_publisher(String, "t", 10)


def test_qos_of_the_wrong_types() -> None:
    for wrong in ({"lifespan": 1.0}, {"deadline": 1}, {"depth": "a"}):
        with pytest.raises(AssertionError, match="expected"):
            QoSProfile(**{"depth": 1, **wrong})  # type: ignore[arg-type]


def test_the_error_of_a_callback_has_its_arguments(graph: GraphHarness) -> None:
    def fail() -> None:
        raise OSError(5, "broken")

    graph.node.create_timer(1.0, fail)
    with pytest.raises(OSError, match="callback of timer") as caught:
        graph.run_for(2.0)
    assert caught.value.args == (5, "broken")
    assert caught.value.errno == 5
