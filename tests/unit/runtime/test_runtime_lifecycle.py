"""Managed nodes: transitions, callbacks, services, publishers."""

from typing import Any

import pytest

from navette.msgs.lifecycle_msgs.msg import Transition, TransitionEvent
from navette.msgs.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from navette.msgs.std_msgs.msg import String
from navette.runtime.exceptions import RCLError
from navette.runtime.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecycleState,
    ManagedEntity,
    Node,
    SimpleManagedEntity,
    State,
    TransitionCallbackReturn,
)
from navette.runtime.lifecycle.state_machine import TRANSITIONS
from navette.runtime.testing import GraphHarness

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR


class Talker(Node):
    """Logs its callbacks, which return the values in ``answers`` by name."""

    def __init__(self, graph: GraphHarness, **answers: Any) -> None:
        super().__init__("talker", context=graph.context)
        self.answers = answers
        self.calls: list[tuple[str, str]] = []
        graph.add(self)

    def _answer(self, name: str, state: State) -> Any:
        self.calls.append((name, state.label))
        answer = self.answers.get(name, SUCCESS)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def on_configure(self, state: State) -> Any:
        return self._answer("configure", state)

    def on_activate(self, state: State) -> Any:
        super().on_activate(state)
        return self._answer("activate", state)

    def on_deactivate(self, state: State) -> Any:
        super().on_deactivate(state)
        return self._answer("deactivate", state)

    def on_cleanup(self, state: State) -> Any:
        return self._answer("cleanup", state)

    def on_shutdown(self, state: State) -> Any:
        return self._answer("shutdown", state)

    def on_error(self, state: State) -> Any:
        return self._answer("error", state)


def state_of(graph: GraphHarness) -> str:
    client = graph.node.create_client(GetState, "/talker/get_state")
    label: str = client.call(GetState.Request()).current_state.label
    return label


def change(graph: GraphHarness, **transition: Any) -> bool:
    client = graph.node.create_client(ChangeState, "/talker/change_state")
    request = ChangeState.Request(transition=Transition(**transition))
    return bool(client.call(request).success)


def test_all_transitions(graph: GraphHarness) -> None:
    node = Talker(graph)
    assert state_of(graph) == "unconfigured"
    assert node.trigger_configure() is SUCCESS
    assert state_of(graph) == "inactive"
    assert node.trigger_activate() is SUCCESS
    assert state_of(graph) == "active"
    assert node.trigger_deactivate() is SUCCESS
    assert node.trigger_cleanup() is SUCCESS
    assert state_of(graph) == "unconfigured"
    assert node.trigger_shutdown() is SUCCESS
    assert state_of(graph) == "finalized"
    assert node.calls == [
        ("configure", "unconfigured"),
        ("activate", "inactive"),
        ("deactivate", "active"),
        ("cleanup", "inactive"),
        ("shutdown", "unconfigured"),
    ]
    with pytest.raises(RCLError, match=r"'shutdown' from state finalized; .*none"):
        node.trigger_shutdown()


def test_transitions_by_the_service(graph: GraphHarness) -> None:
    Talker(graph)
    assert change(graph, id=Transition.TRANSITION_CONFIGURE)
    assert change(graph, label="activate")
    assert not change(graph, label="configure")
    assert not change(graph, id=Transition.TRANSITION_CLEANUP)
    assert state_of(graph) == "active"
    assert change(graph, label="shutdown")
    assert state_of(graph) == "finalized"


def test_a_failure_restores_the_state(graph: GraphHarness) -> None:
    node = Talker(graph, configure=FAILURE)
    assert node.trigger_configure() is FAILURE
    assert state_of(graph) == "unconfigured"


@pytest.mark.parametrize(
    ("answer", "end"), [(SUCCESS, "unconfigured"), (FAILURE, "finalized")]
)
@pytest.mark.parametrize("fault", [ERROR, ValueError("no port"), None])
def test_errors_are_processed(
    graph: GraphHarness, fault: Any, answer: Any, end: str
) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log", latched=True)
    answers = {"configure": fault, "error": answer}
    node = Talker(graph, **answers)
    assert node.trigger_configure() is ERROR
    assert state_of(graph) == end
    assert node.calls[-1] == ("error", "unconfigured")
    graph.run_for(0.1)
    logged = "\n".join(message.msg for message in logs.messages)
    assert ("ValueError: no port" in logged) is isinstance(fault, ValueError)
    assert ("expected a TransitionCallbackReturn" in logged) is (fault is None)


def test_events_of_transitions(graph: GraphHarness) -> None:
    events = graph.collect("/talker/transition_event", TransitionEvent)
    node = Talker(graph)
    graph.run_for(1.0)
    node.trigger_configure()
    graph.run_for(0.1)
    assert [
        (e.start_state.label, e.transition.label, e.goal_state.label, e.timestamp)
        for e in events.messages
    ] == [
        ("unconfigured", "configure", "configuring", 1_000_000_000),
        ("configuring", "transition_success", "inactive", 1_000_000_000),
    ]


def test_services_that_list_states_and_transitions(graph: GraphHarness) -> None:
    Talker(graph)
    client = graph.node.create_client(GetAvailableStates, "talker/get_available_states")
    labels = {
        s.label for s in client.call(GetAvailableStates.Request()).available_states
    }
    assert {"unknown", "active", "errorprocessing"} <= labels
    assert len(labels) == 11
    for name, count in (
        ("get_available_transitions", 2),
        ("get_transition_graph", 25),
    ):
        found = graph.node.create_client(GetAvailableTransitions, f"talker/{name}")
        answer = found.call(GetAvailableTransitions.Request())
        assert len(answer.available_transitions) == count
    constants = {
        value for name, value in vars(Transition).items() if name.startswith("TRANSIT")
    }
    assert {transition.id for transition in TRANSITIONS} <= constants


def test_publishers_publish_only_while_active(graph: GraphHarness) -> None:
    node = Talker(graph)
    received = graph.collect("/chatter", String)
    publisher = node.create_lifecycle_publisher(String, "chatter", 10)
    publisher.publish(String(data="too early"))
    node.trigger_configure()
    node.trigger_activate()
    assert publisher.is_activated
    publisher.publish(String(data="now"))
    node.trigger_deactivate()
    publisher.publish(String(data="too late"))
    graph.run_for(0.1)
    assert [message.data for message in received.messages] == ["now"]
    assert node.destroy_lifecycle_publisher(publisher)
    assert not node.destroy_lifecycle_publisher(publisher)


def test_managed_entities(graph: GraphHarness) -> None:
    class Arm(SimpleManagedEntity):
        moves = 0
        refused = 0

        def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
            return FAILURE

        @SimpleManagedEntity.when_enabled
        def move(self) -> None:
            self.moves += 1

        def refuse() -> None:  # type: ignore[misc]
            Arm.refused += 1

        @SimpleManagedEntity.when_enabled(when_not_enabled=refuse)  # type: ignore[arg-type]
        def move_loudly(self) -> None:
            self.moves += 1

    node = graph.add(LifecycleNode("n", context=graph.context))
    arm = Arm()
    node.add_managed_entity(ManagedEntity())
    node.add_managed_entity(arm)
    assert node.trigger_configure() is FAILURE
    arm.move()
    arm.move_loudly()
    arm.on_activate(LifecycleState("inactive", 2))
    arm.move()
    assert (arm.moves, Arm.refused) == (1, 1)


def test_wrong_use(graph: GraphHarness) -> None:
    node: Any = LifecycleNode(
        "quiet", context=graph.context, enable_communication_interface=False
    )
    assert node.count_services("~/change_state") == 0
    assert node.trigger_activate() is ERROR
    with pytest.raises(TypeError, match="expected a ManagedEntity, got 3"):
        node.add_managed_entity(3)
    with pytest.raises(TypeError, match="do not accept a publisher_class"):
        node.create_lifecycle_publisher(String, "t", 1, publisher_class=object)
    with pytest.raises(RuntimeError, match="needs Node"):
        LifecycleNodeMixin()
