"""``navette stop`` and ``navette cancel`` in the graph of a robot."""

from collections.abc import Iterator
from typing import Any

import pytest
from verb_world import World, world

from navette.msgs.geometry_msgs.msg import Twist, Vector3
from navette.msgs.nav2_msgs.action import NavigateToPose
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.arbiter.node import ArbiterNode
from navette.runtime import Node
from navette.runtime.action import ActionClient, ActionServer, CancelResponse


@pytest.fixture
def here() -> Iterator[World]:
    with world() as made:
        yield made


def add(world: World, name: str, namespace: str = "") -> Node:
    return world.graph.add(Node(name, namespace=namespace, context=world.context))


def test_stop_confirms_and_release_lets_the_robot_drive(here: World) -> None:
    here.graph.add(ArbiterNode(context=here.context))
    operator = add(here, "operator")
    keys = operator.create_publisher(Twist, "/cmd_vel_teleop", 10)
    wheels: list[float] = []
    operator.create_subscription(
        Twist, "/cmd_vel", lambda msg: wheels.append(msg.linear.x), 10
    )
    assert here.read("stop") == "robot: stopped until: navette stop --release\n"
    keys.publish(Twist(linear=Vector3(x=0.3)))
    here.graph.run_for(0.2)
    assert set(wheels) == {0.0}
    assert here.read("stop") == "robot: stopped until: navette stop --release\n"
    assert here.read("stop", "--release") == "robot: released\n"
    keys.publish(Twist(linear=Vector3(x=0.3)))
    here.graph.run_for(0.1)
    assert wheels[-1] == 0.3


def test_every_robot_is_stopped(here: World) -> None:
    for namespace in ("/one", "/two"):
        rules = [
            f"{topic}:={namespace}{topic}"
            for topic in ("/emergency_stop", "/emergency_stop/release", "/commander")
        ]
        arguments = [word for rule in rules for word in ("-r", rule)]
        here.graph.add(
            ArbiterNode(
                context=here.context,
                namespace=namespace,
                cli_args=["--ros-args", *arguments],
            )
        )
    assert here.read("stop").splitlines() == [
        "one: stopped until: navette stop --release",
        "two: stopped until: navette stop --release",
    ]
    assert here.read("stop", "--release").splitlines() == [
        "one: released",
        "two: released",
    ]


def test_all_is_the_only_network_where_no_run_chooses_it(here: World) -> None:
    here.graph.add(ArbiterNode(context=here.context))
    assert (
        here.read("stop", "--all") == "robot: stopped until: navette stop --release\n"
    )


def test_stop_without_a_robot_fails(here: World) -> None:
    done = here.run("stop")
    assert done.code == 1
    assert "no node subscribes to /emergency_stop" in done.err


def test_a_stop_that_is_not_confirmed_fails(here: World) -> None:
    deaf = add(here, "deaf")
    received: list[Bool] = []
    deaf.create_subscription(Bool, "/emergency_stop", received.append, 10)
    done = here.run("stop")
    assert done.code == 1
    assert "/commander" in done.err
    assert len(received) > 10, "the request is repeated"


def test_cancel_ends_the_goals_of_all_clients(here: World) -> None:
    robot, program = add(here, "robot"), add(here, "program")

    waiting: list[Any] = []
    ActionServer(
        robot,
        NavigateToPose,
        "navigate_to_pose",
        execute_callback=lambda handle: NavigateToPose.Result(),
        handle_accepted_callback=waiting.append,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    client = ActionClient(program, NavigateToPose, "navigate_to_pose")
    sent = client.send_goal_async(NavigateToPose.Goal())
    here.graph.run_for(0.1)
    assert sent.result().accepted
    assert here.read("cancel") == "cancelled: /navigate_to_pose\n"
    assert waiting[0].is_cancel_requested


def test_cancel_without_an_active_goal(here: World) -> None:
    planner = add(here, "planner")
    cancels: list[Empty] = []
    planner.create_subscription(Empty, "/cancel_goal", cancels.append, 10)
    assert here.read("cancel") == "requested on /cancel_goal\n"
    assert len(cancels) == 1


def test_cancel_without_a_robot_fails(here: World) -> None:
    done = here.run("cancel")
    assert done.code == 1
    assert "no node navigates" in done.err
