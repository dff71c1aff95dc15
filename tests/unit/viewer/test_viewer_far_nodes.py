"""Nodes of another session: parameters, liveness, the last path."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from viewer_harness import PATIENCE_S, Client, Program

from free_ports import free_endpoint
from navette.msgs import deserialize
from navette.msgs.nav_msgs.msg import Path
from navette.msgs.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from navette.msgs.std_msgs.msg import Header
from navette.runtime import Context, Executor, Node, Parameter


class Far:
    """A node with its own session, loop and thread."""

    def __init__(self) -> None:
        self.context = Context(transport="zenoh")
        self.node = Node("far", context=self.context)
        bounds = FloatingPointRange(from_value=0.0, to_value=2.0)
        self.node.declare_parameter(
            "speed_mps", 1.0, ParameterDescriptor(floating_point_range=[bounds])
        )
        self.path = self.node.create_publisher(Path, "/path", 10)
        self.executor = Executor(context=self.context)
        self.executor.add_node(self.node)
        self.thaw = threading.Event()
        self._thread = threading.Thread(target=self.executor.spin)
        self._thread.start()

    def do(self, work: Any) -> None:
        self.executor.call_soon_threadsafe(work)

    def freeze(self) -> None:
        """In a callback that does not come back, until :attr:`thaw`."""
        self.do(lambda: self.thaw.wait(PATIENCE_S))

    def close(self) -> None:
        self.thaw.set()
        self.executor.stop()
        self._thread.join()
        self.context.try_shutdown()


@pytest.fixture
def program(monkeypatch: pytest.MonkeyPatch) -> Iterator[Program]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    with Program(transport="zenoh") as running:
        yield running


@pytest.fixture
def far(program: Program) -> Iterator[Far]:
    far = Far()
    try:
        yield far
    finally:
        far.close()


@pytest.fixture
def client(program: Program, far: Far) -> Iterator[Client]:
    with Client(program.address) as connected:
        connected.wait_for_topic("/path")
        connected.send(op="subscribeNodes")
        connected.send(op="subscribeParameterUpdates", parameterNames=[])
        yield connected


def set_speed(client: Client, value: float) -> None:
    speed = {"name": "/far.speed_mps", "value": value, "type": "float64"}
    client.send(op="setParameters", parameters=[speed], id="set")


def wait_for_state(client: Client, state: str) -> None:
    client.wait_for(
        lambda frame: (
            isinstance(frame, dict)
            and frame["op"] == "nodes"
            and {"/far": state}.items()
            <= {each["name"]: each["state"] for each in frame["nodes"]}.items()
        )
    )


def wait_for_speed(client: Client, value: float | None) -> None:
    client.wait_for(
        lambda frame: (
            isinstance(frame, dict)
            and frame["op"] == "parameterValues"
            and any(
                each["name"] == "/far.speed_mps" and each.get("value") == value
                for each in frame["parameters"]
            )
        )
    )


def test_parameters_are_listed_described_set_and_refused(
    client: Client, far: Far
) -> None:
    texts = client.wait_for(
        lambda frame: (
            isinstance(frame, dict)
            and frame["op"] == "parameterTexts"
            and any(each["name"] == "/far.speed_mps" for each in frame["parameters"])
        )
    )
    (speed,) = (t for t in texts["parameters"] if t["name"] == "/far.speed_mps")
    assert (speed["low"], speed["high"]) == (0.0, 2.0)
    assert client.get_parameters()["/far.speed_mps"] == 1.0
    set_speed(client, 1.5)
    wait_for_speed(client, 1.5)
    set_speed(client, 9.0)
    complaint = client.wait_for_op("status")["message"]
    assert complaint.startswith("parameter '/far.speed_mps'")
    assert "9.0" in complaint
    # Somebody else changes it.
    far.do(lambda: far.node.set_parameters([Parameter("speed_mps", value=0.5)]))
    wait_for_speed(client, 0.5)


def test_a_late_client_receives_the_last_path(
    program: Program, far: Far, client: Client
) -> None:
    client.subscribe("/path", 1)
    # Published until received: the publisher must discover the subscription first.
    path = Path(header=Header(frame_id="map"))
    timer = far.node.create_timer(0.3, lambda: far.path.publish(path))
    client.message(1)
    far.do(timer.cancel)
    with Client(program.address) as late:
        late.subscribe("/path", 2)
        assert deserialize(late.message(2)[1], Path).header.frame_id == "map"


@pytest.mark.slow
def test_a_blocked_node_is_silent_and_an_ended_node_is_gone(
    client: Client, far: Far
) -> None:
    wait_for_state(client, "alive")
    wait_for_speed(client, 1.0)
    far.freeze()
    set_speed(client, 1.5)
    reason = client.wait_for_op("status")["message"]
    assert reason == "parameter '/far.speed_mps': node /far: no response in 2 s"
    wait_for_state(client, "silent")
    far.thaw.set()
    wait_for_state(client, "alive")
    far.close()
    wait_for_speed(client, None)
    wait_for_state(client, "gone")
