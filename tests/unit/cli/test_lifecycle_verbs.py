"""``navette lifecycle``: texts as of ros2 lifecycle."""

import json
from collections.abc import Iterator
from typing import Any

import pytest
from verb_world import World, world

from navette.msgs.lifecycle_msgs.msg import Transition, TransitionDescription
from navette.msgs.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableTransitions,
    GetState,
)
from navette.runtime import Future, Node
from navette.runtime.lifecycle import LifecycleNode, TransitionCallbackReturn
from navette.runtime.lifecycle.state_machine import LifecycleState


class Camera(LifecycleNode):
    """Does not get active."""

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.FAILURE


@pytest.fixture
def here() -> Iterator[World]:
    with world() as here:
        here.graph.add(Camera("camera", context=here.context))
        here.graph.add(LifecycleNode("arm", context=here.context))
        here.graph.add(Node("plain", context=here.context))
        yield here


def test_a_transition_that_takes_its_time(here: World) -> None:
    node = here.graph.add(Node("driver", context=here.context))
    hardware = here.graph.add(Node("hardware", context=here.context))
    node.create_service(GetState, "~/get_state", lambda request, response: response)

    def transitions(request: Any, response: Any) -> Any:
        response.available_transitions = [
            TransitionDescription(transition=Transition(id=1, label="configure"))
        ]
        return response

    async def change(request: Any, response: Any) -> Any:
        done: Future[None] = Future()
        hardware.create_timer(20.0, lambda: done.done() or done.set_result(None))
        await done
        response.success = True
        return response

    node.create_service(
        GetAvailableTransitions, "~/get_available_transitions", transitions
    )
    node.create_service(ChangeState, "~/change_state", change)
    done = here.run("lifecycle", "set", "driver", "configure")
    assert (done.out, done.code) == ("Transitioning successful\n", 0)
    assert done.err.startswith("waiting for /driver")


def test_nodes(here: World) -> None:
    assert here.read("lifecycle", "nodes") == "/arm\n/camera\n"
    assert here.read("lifecycle", "nodes", "-c") == "2\n"
    assert json.loads(here.read("lifecycle", "nodes", "--json")) == [
        "/arm",
        "/camera",
    ]


def test_get(here: World) -> None:
    assert here.read("lifecycle", "get", "camera") == "unconfigured [1]\n"
    assert here.read("lifecycle", "get") == (
        "/arm: unconfigured [1]\n/camera: unconfigured [1]\n"
    )
    one = json.loads(here.read("lifecycle", "get", "arm", "--json"))
    assert one == {"id": 1, "label": "unconfigured"}


def test_set_by_label_and_id(here: World) -> None:
    assert here.read("lifecycle", "set", "camera", "configure") == (
        "Transitioning successful\n"
    )
    assert here.read("lifecycle", "get", "camera") == "inactive [2]\n"
    here.read("lifecycle", "set", "camera", "2")  # cleanup
    assert here.read("lifecycle", "get", "camera") == "unconfigured [1]\n"


def test_set_that_fails(here: World) -> None:
    here.read("lifecycle", "set", "camera", "configure")
    done = here.run("lifecycle", "set", "camera", "activate")
    assert (done.out, done.err, done.code) == ("", "navette: Transitioning failed\n", 1)


def test_an_unavailable_transition(here: World) -> None:
    done = here.run("lifecycle", "set", "camera", "configur")
    assert done.code == 1
    assert done.err == (
        "navette: no transition 'configur' from the current state; did you mean"
        " configure?\navailable transitions:\n- configure [1]\n- shutdown [5]\n"
    )


def test_list(here: World) -> None:
    assert here.read("lifecycle", "list", "camera") == (
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
        "- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n"
    )
    every = here.read("lifecycle", "list", "camera", "-a")
    assert "- activate [3]\n\tStart: inactive\n\tGoal: activating\n" in every
    as_json = json.loads(here.read("lifecycle", "list", "camera", "--json"))
    assert as_json[0] == {
        "id": 1,
        "label": "configure",
        "start": "unconfigured",
        "goal": "configuring",
    }


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("plain", "node /plain is not managed; managed nodes: /arm, /camera"),
        ("camra", "no node /camra; did you mean /camera?"),
    ],
)
def test_a_node_that_is_not_managed(here: World, name: str, reason: str) -> None:
    for verb in (["get", name], ["list", name], ["set", name, "configure"]):
        done = here.run("lifecycle", *verb)
        assert (done.out, done.err, done.code) == ("", f"navette: {reason}\n", 1)
