"""Nav2's behavior actions on a simulated Jackal in a room."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from navette.geometry import Pose2, angle_difference, yaw_of
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.builtin_interfaces.msg import Duration
from navette.msgs.geometry_msgs.msg import Point, Twist, TwistStamped, Vector3
from navette.msgs.nav2_msgs.action import (
    AssistedTeleop,
    BackUp,
    DriveOnHeading,
    Spin,
    Wait,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.arbiter.node import ArbiterNode
from navette.navigation.behaviors.node import BehaviorNode
from navette.navigation.costmap.node import CostmapNode
from navette.navigation.mapping.node import MapMemoryNode
from navette.navigation.stack.robot import simulate_robot
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness
from navette.sim import World

FRONT_M = 0.254  # from the axle to the bumper


class Room:
    """A robot at the origin of a room with a wall 1.9 m ahead and 4 m behind.

    Its lidar has not seen the space behind it, but it may back into it.
    """

    def __init__(self, graph: GraphHarness, blind_reverse_m: float = 10.0) -> None:
        self.graph = graph
        blind = {"blind_reverse_m": blind_reverse_m}
        graph.context.overrides.add("behaviors", blind, "test")
        world = World("room").add_walls((12.0, 12.0)).add_box((2.0, 0.0), (0.2, 8.0))
        scene = world.add_box((-4.1, 0.0), (0.2, 8.0)).scene()
        self.sim = graph.add(
            simulate_robot(scene, "jackal", start=Pose2(0, 0, 0), context=graph.context)
        )
        self.costmap = graph.add(CostmapNode(context=graph.context))
        graph.add(MapMemoryNode(context=graph.context))
        self.node = graph.add(BehaviorNode(context=graph.context))
        graph.add(ArbiterNode(context=graph.context))
        self.odometry = graph.collect("/odom/filtered", Odometry)
        self.commands = graph.collect("/cmd_vel", Twist)
        graph.run_for(1.0)

    @property
    def pose(self) -> Pose2:
        pose = self.odometry.last.pose.pose
        q = pose.orientation
        return Pose2(pose.position.x, pose.position.y, yaw_of((q.x, q.y, q.z, q.w)))

    @property
    def speed(self) -> float:
        return abs(float(self.odometry.last.twist.twist.linear.x))

    @property
    def turn_rate(self) -> float:
        return abs(float(self.odometry.last.twist.twist.angular.z))

    def send(self, action: Any, name: str, **fields: Any) -> Any:
        return self.graph.send_goal(action, name, action.Goal(**fields))

    def finish(self, probe: Any, timeout_s: float = 30.0) -> Any:
        assert self.graph.run_until(lambda: probe.done, timeout_s)
        assert self.speed < 0.05
        assert self.turn_rate < 0.08
        return probe.result

    def back_up(self, metres: float, speed: float = 0.3, **fields: Any) -> Any:
        return self.send(
            BackUp, "backup", target=Point(x=metres), speed=speed, **fields
        )

    def drive(self, metres: float, speed: float = 0.3, **fields: Any) -> Any:
        target = Point(x=metres)
        return self.send(
            DriveOnHeading, "drive_on_heading", target=target, speed=speed, **fields
        )


@pytest.fixture
def room() -> Iterator[Room]:
    with GraphHarness() as graph:
        yield Room(graph)


@pytest.mark.parametrize("angle", [1.57, -1.57, 6.5, 0.1])
def test_spin_turns_by_the_angle(room: Room, angle: float) -> None:
    probe = room.send(Spin, "spin", target_yaw=angle)
    result = room.finish(probe)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert (result.error_code, result.error_msg) == (0, "")
    assert abs(angle_difference(room.pose.yaw, angle)) < 0.06
    assert probe.feedback[-1].angular_distance_traveled == pytest.approx(angle, abs=0.1)
    assert math.hypot(*room.pose[:2]) < 0.1
    elapsed = result.total_elapsed_time
    assert 0.1 < elapsed.sec + elapsed.nanosec / 1e9 < 20.0


def test_backup_drives_back_whatever_the_signs(room: Room) -> None:
    for metres, speed in ((0.5, 0.25), (-0.4, 0.25), (0.3, -0.25)):
        x = room.pose.x
        probe = room.back_up(metres, speed)
        room.finish(probe)
        assert probe.status == GoalStatus.STATUS_SUCCEEDED
        assert x - room.pose.x == pytest.approx(abs(metres), abs=0.03)
        driven = [feedback.distance_traveled for feedback in probe.feedback]
        assert driven[-1] == pytest.approx(abs(metres), abs=0.03)
        assert driven == sorted(driven)


def test_backup_stays_in_space_that_was_seen() -> None:
    with GraphHarness() as graph:
        room = Room(graph, blind_reverse_m=0.1)
        probe = room.back_up(0.5)
        result = room.finish(probe)
        assert result.error_code == BackUp.Result.COLLISION_AHEAD
        assert "unseen space" in result.error_msg
        assert room.pose.x > -0.1
        room.finish(room.send(Spin, "spin", target_yaw=2 * math.pi))
        probe = room.back_up(0.5)
        room.finish(probe)
        assert probe.status == GoalStatus.STATUS_SUCCEEDED


def test_drive_on_heading_goes_ahead_and_back(room: Room) -> None:
    for metres, speed in ((0.6, 0.3), (-0.6, -0.3)):
        x = room.pose.x
        probe = room.drive(metres, speed)
        room.finish(probe)
        assert probe.status == GoalStatus.STATUS_SUCCEEDED
        assert room.pose.x - x == pytest.approx(metres, abs=0.03)


def test_the_requested_speed_is_limited(room: Room) -> None:
    room.finish(room.back_up(2.0, 9.0))
    assert min(twist.linear.x for twist in room.commands.messages) >= -0.5


@pytest.mark.parametrize(
    ("metres", "speed", "reason"),
    [
        (0.5, -0.2, "signs differ"),
        (0.5, 0.0, "speed 0"),
        (math.nan, 0.2, "finite"),
        (0.5, math.inf, "finite"),
    ],
)
def test_invalid_drives_are_refused(
    room: Room, metres: float, speed: float, reason: str
) -> None:
    probe = room.drive(metres, speed)
    result = room.finish(probe, 1.0)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert result.error_code == DriveOnHeading.Result.INVALID_INPUT
    assert reason in result.error_msg


def test_sideways_is_refused(room: Room) -> None:
    sideways = room.send(BackUp, "backup", target=Point(x=0.1, y=0.1), speed=0.1)
    assert room.finish(sideways, 1.0).error_code == BackUp.Result.INVALID_INPUT
    turn = room.send(Spin, "spin", target_yaw=math.nan)
    assert room.finish(turn, 1.0).error_code == Spin.Result.UNKNOWN


def test_a_spin_is_refused_where_the_drive_cannot_turn_in_place(room: Room) -> None:
    room.node.set_parameters([Parameter("drive", value="ackermann")])
    spin = room.send(Spin, "spin", target_yaw=1.57)
    result = room.finish(spin, 1.0)
    assert spin.status == GoalStatus.STATUS_ABORTED
    assert "cannot turn in place" in result.error_msg


def test_an_obstacle_ahead_ends_the_drive_before_it(room: Room) -> None:
    probe = room.drive(3.0, 0.4)
    result = room.finish(probe)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert result.error_code == DriveOnHeading.Result.COLLISION_AHEAD
    assert room.pose.x + FRONT_M < 1.85
    assert room.sim.simulator.contacts.count == 0


def test_behind_the_robot_the_map_counts(room: Room) -> None:
    """The lidar of the Jackal does not see what is behind it."""
    room.finish(room.send(Spin, "spin", target_yaw=math.pi))
    room.graph.run_for(1.5)
    room.finish(room.send(Spin, "spin", target_yaw=math.pi))
    probe = room.back_up(6.0, 0.4)
    assert room.finish(probe).error_code == BackUp.Result.COLLISION_AHEAD
    assert room.pose.x - FRONT_M > -3.95
    assert room.pose.x < -2.0
    assert room.sim.simulator.contacts.count == 0


def test_the_time_allowance_ends_a_behavior(room: Room) -> None:
    brief = Duration(sec=1)

    def ends_with(probe: Any, code: int) -> None:
        started = room.graph.now_ns
        result = room.finish(probe)
        assert result.error_code == code
        assert "1 s" in result.error_msg
        assert 1.0e9 <= room.graph.now_ns - started < 2.0e9

    ends_with(room.back_up(2.0, 0.2, time_allowance=brief), BackUp.Result.TIMEOUT)
    spin = room.send(Spin, "spin", target_yaw=6.0, time_allowance=brief)
    ends_with(spin, Spin.Result.TIMEOUT)


def test_a_cancelled_behavior_is_answered_at_rest(room: Room) -> None:
    drive = room.back_up(3.0, 0.5)
    room.graph.run_until(lambda: room.speed > 0.3)
    drive.cancel()
    room.finish(drive, 3.0)
    assert drive.status == GoalStatus.STATUS_CANCELED
    spin = room.send(Spin, "spin", target_yaw=6.0)
    room.graph.run_until(lambda: room.turn_rate > 0.5)
    spin.cancel()
    room.finish(spin, 3.0)
    assert spin.status == GoalStatus.STATUS_CANCELED
    place = room.pose
    room.graph.run_for(2.0)
    assert abs(angle_difference(room.pose.yaw, place.yaw)) < 0.02


def test_one_behavior_at_a_time(room: Room) -> None:
    first = room.back_up(3.0, 0.3)
    room.graph.run_for(1.0)
    spin = room.send(Spin, "spin", target_yaw=1.0)
    room.graph.run_for(0.2)
    assert first.status == GoalStatus.STATUS_ABORTED
    assert first.result.error_msg == "preempted by spin"
    again = room.send(Spin, "spin", target_yaw=-1.0)
    room.graph.run_for(0.2)
    assert spin.result.error_msg == "preempted by a new goal"
    room.finish(again)
    assert again.status == GoalStatus.STATUS_SUCCEEDED
    room.graph.run_for(1.0)
    count = room.commands.count
    room.graph.run_for(2.0)
    assert room.commands.count == count  # at rest nothing is published


def test_wait_takes_its_time_and_commands_nothing(room: Room) -> None:
    before = room.commands.count
    started = room.graph.now_ns
    probe = room.send(Wait, "wait", time=Duration(sec=2))
    room.finish(probe)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert room.graph.now_ns - started == pytest.approx(2e9, abs=0.1e9)
    left = [f.time_left.sec + f.time_left.nanosec / 1e9 for f in probe.feedback]
    assert left[0] == pytest.approx(1.95, abs=0.06)
    assert left == sorted(left, reverse=True)
    assert room.commands.count == before
    probe = room.send(Wait, "wait", time=Duration(sec=60))
    room.graph.run_for(0.5)
    probe.cancel()
    room.finish(probe, 0.5)
    assert probe.status == GoalStatus.STATUS_CANCELED


def test_stale_inputs_stop_and_then_end_the_behavior(room: Room) -> None:
    probe = room.back_up(3.0, 0.3)
    room.graph.run_until(lambda: room.speed > 0.25)
    room.graph.executor.remove_node(room.costmap)
    room.costmap.destroy_node()
    result = room.finish(probe, 5.0)
    assert result.error_code == BackUp.Result.COLLISION_AHEAD
    assert "costmap" in result.error_msg
    assert room.pose.x > -1.2


def test_without_odometry_a_behavior_ends_with_a_tf_error() -> None:
    with GraphHarness() as graph:
        graph.add(BehaviorNode(context=graph.context))
        probe = graph.send_goal(Spin, "spin", Spin.Goal(target_yaw=1.0))
        assert graph.run_until(lambda: probe.done, 5.0)
        assert probe.result.error_code == Spin.Result.TF_ERROR


def test_assisted_teleop_slows_down_before_the_wall(room: Room) -> None:
    def steer(_now_ns: int) -> Twist:
        return Twist(linear=Vector3(x=0.5))

    probe = room.send(AssistedTeleop, "assisted_teleop")
    room.graph.run_for(0.2)
    room.graph.publish_every(0.1, "/cmd_vel_teleop", steer)
    room.graph.run_for(8.0)
    assert not probe.done
    assert 1.2 < room.pose.x + FRONT_M < 1.87
    assert room.speed < 0.02
    assert room.sim.simulator.contacts.count == 0
    duration = probe.feedback[-1].current_teleop_duration
    assert duration.sec == 8
    room.graph.publish("/preempt_teleop", Empty())
    room.finish(probe, 3.0)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED


def test_assisted_teleop_takes_stamped_commands_and_times_out(room: Room) -> None:
    allowance = Duration(sec=2)
    probe = room.send(AssistedTeleop, "assisted_teleop", time_allowance=allowance)
    room.graph.run_for(0.1)
    for _ in range(10):
        twist = TwistStamped(twist=Twist(linear=Vector3(x=-0.2)))
        room.graph.publish("/cmd_vel_teleop", twist)
        room.graph.run_for(0.1)
    assert room.pose.x < -0.1
    room.graph.run_for(0.8)  # the last command expires
    assert room.speed < 0.02
    assert room.finish(probe, 3.0).error_code == AssistedTeleop.Result.TIMEOUT


def test_time_does_not_count_while_the_emergency_stop_is_engaged(room: Room) -> None:
    probe = room.back_up(0.5, 0.25, time_allowance=Duration(sec=4))
    room.graph.run_for(0.5)
    room.graph.publish("/emergency_stop", Bool(data=True))
    room.graph.run_for(6.0)
    assert not probe.done
    assert room.speed < 0.01
    room.graph.publish("/emergency_stop/release", Empty())
    room.finish(probe)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert room.pose.x == pytest.approx(-0.5, abs=0.03)


def test_changed_parameters_end_the_goal(room: Room) -> None:
    probe = room.back_up(2.0, 0.3)
    room.graph.run_for(1.0)
    room.node.set_parameters([Parameter("max_speed_mps", value=0.1)])
    room.graph.run_for(1.0)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert room.speed < 0.02
    room.finish(room.back_up(0.3, 0.3))
    slow = [twist.linear.x for twist in room.commands.messages[-40:]]
    assert min(slow) == pytest.approx(-0.1)
