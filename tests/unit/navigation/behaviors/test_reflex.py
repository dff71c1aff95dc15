"""The reflex to a contact."""

import math

import pytest

from navette.geometry import Pose2
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import (
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.msgs.irobot_create_msgs.msg import HazardDetection, HazardDetectionVector
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.behaviors.reflex import BumperReflex, ReflexParams
from navette.navigation.behaviors.reflex.node import ReflexNode
from navette.navigation.behaviors.reflex.reflex import NO_CONTACT, Contacts
from navette.runtime.testing import GraphHarness, Probe

STEP_NS = 50_000_000
PARAMS = ReflexParams(backoff_m=0.2, speed_mps=0.1, stop_s=0.2)


def driven(
    reflex: BumperReflex,
    *,
    seconds: float,
    moves: bool = True,
    has_odometry: bool = True,
) -> tuple[list[float | None], float]:
    """Step a reflex; return its commands and the position at the end."""
    x, commands = 0.0, []
    for k in range(round(seconds * 1e9 / STEP_NS)):
        pose = Pose2(x, 0.0, 0.0) if has_odometry else None
        speed = reflex.step(pose, k * STEP_NS)
        commands.append(speed)
        if moves:
            x += (speed or 0.0) * STEP_NS / 1e9
    return commands, x


@pytest.mark.parametrize(
    ("contacts", "expected"),
    [
        (Contacts(ahead=True), -0.2),
        (Contacts(behind=True), 0.2),
        (Contacts(ahead=True, behind=True), 0.0),
    ],
)
def test_the_robot_stops_and_moves_away_from_the_contact(
    contacts: Contacts, expected: float
) -> None:
    reflex = BumperReflex(PARAMS)
    assert reflex.step(Pose2(0.0, 0.0, 0.0), 0) is None
    assert reflex.touch(contacts, 0)
    commands, x = driven(reflex, seconds=4.0)
    assert commands[:4] == [0.0] * 4  # stop_s
    assert x == pytest.approx(expected, abs=0.011)
    assert commands[-1] is None
    last = [c for c in commands if c is not None]
    assert last[-4:] == [0.0] * 4
    assert not reflex.is_active


def test_a_bumper_that_stays_pressed_does_not_repeat_it() -> None:
    reflex = BumperReflex(PARAMS)
    assert reflex.touch(Contacts(ahead=True), 0)
    driven(reflex, seconds=4.0)
    assert not reflex.touch(Contacts(ahead=True), 5 * 10**9)
    reflex.touch(NO_CONTACT, 6 * 10**9)
    assert reflex.touch(Contacts(ahead=True), 7 * 10**9)


def test_a_contact_behind_ends_backing_off() -> None:
    reflex = BumperReflex(PARAMS)
    reflex.touch(Contacts(ahead=True), 0)
    assert reflex.step(Pose2(0.0, 0.0, 0.0), 500_000_000) == -0.1
    reflex.touch(Contacts(behind=True), 550_000_000)
    assert reflex.step(Pose2(-0.05, 0.0, 0.0), 600_000_000) == 0.0


@pytest.mark.parametrize("has_odometry", [True, False])
def test_a_robot_that_does_not_move_ends_in_time(has_odometry: bool) -> None:
    reflex = BumperReflex(PARAMS)
    reflex.touch(Contacts(ahead=True), 0)
    commands, _ = driven(reflex, seconds=6.0, moves=False, has_odometry=has_odometry)
    moving = sum(command == -0.1 for command in commands) * STEP_NS / 1e9
    assert moving == pytest.approx(4.0 if has_odometry else 2.0, abs=0.11)
    assert commands[-1] is None


# The node


def hazards(*frames: str, kind: int = HazardDetection.BUMP) -> HazardDetectionVector:
    return HazardDetectionVector(
        header=Header(stamp=Time(sec=1), frame_id="base_link"),
        detections=[
            HazardDetection(header=Header(frame_id=frame), type=kind)
            for frame in frames
        ],
    )


def started(graph: GraphHarness) -> tuple[ReflexNode, Probe]:
    node = graph.add(ReflexNode(context=graph.context))
    commands = graph.collect("/cmd_vel_reflex", "geometry_msgs/msg/Twist")
    transforms = [
        TransformStamped(
            header=Header(frame_id="base_link"),
            child_frame_id=name,
            transform=Transform(translation=Vector3(x=x), rotation=Quaternion(w=1.0)),
        )
        for name, x in (("front", 0.3), ("rear", -0.3))
    ]
    graph.publish("/tf_static", TFMessage(transforms=transforms), latched=True)
    graph.run_for(0.1)
    return node, commands


def test_the_node_commands_only_after_a_contact() -> None:
    with GraphHarness() as graph:
        _, commands = started(graph)
        graph.publish("/hazard_detection", hazards())
        graph.publish("/hazard_detection", hazards("front", kind=HazardDetection.CLIFF))
        graph.run_for(1.0)
        assert commands.count == 0
        graph.publish("/hazard_detection", hazards("front"))
        graph.run_for(10.0)
        speeds = [msg.linear.x for msg in commands.messages]
        assert speeds[0] == 0.0
        assert min(speeds) == -0.15
        assert speeds[-1] == 0.0
        assert all(math.isfinite(each) for each in speeds)
        count = commands.count
        graph.run_for(1.0)
        assert commands.count == count


def test_a_bumper_of_an_unknown_frame_is_dropped_with_its_reason() -> None:
    with GraphHarness() as graph:
        node, commands = started(graph)
        graph.publish("/hazard_detection", hazards("elsewhere"))
        graph.run_for(0.5)
        assert commands.count == 0
        assert ("/hazard_detection", "unknown_frame") in node.dropped_inputs
