"""A filter with GNSS that something contradicts: what it reports, and how it ends."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from navette.geometry import Pose2, Transform3
from navette.geometry.geodesy import GeoPoint
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Twist
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Timer
from navette.sim.gnss import Fix
from navette.sim.instant import Instant
from navette.sim.sensor_specs import GnssSensor

pytestmark = pytest.mark.long

FILTERS = ("odometry+gnss", "odometry+imu+gnss")
DISTURBED_S = 4.0
REASON = "gps0 contradicts the estimate"
METRE_DEG = 1 / 111_195.0  # of latitude


@dataclass
class Drive:
    """What happened in a run of 20 m over open ground, disturbed after 4 s."""

    result: str = ""
    contacts: int = 0
    worst_m: float = math.nan
    final_m: float = math.nan
    states: list[str] = field(default_factory=list)
    reasons: set[str] = field(default_factory=set)
    lost_after_s: float = math.nan
    last_speed_mps: float = math.nan


def drive(
    localization: str, disturb: Callable[[Simulation], None], max_time_s: float = 60.0
) -> Drive:
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=Pose2(0.0, 0.0, 0.0),
        goals=((20.0, 0.0),),
        headless=True,
        speed=math.inf,
        methods={"localization": localization},
        max_time_s=max_time_s,
    )
    simulation, found = Simulation(options), Drive()
    watch = simulation.monitor

    def note(msg: DiagnosticStatus) -> None:
        if found.states[-1:] != [msg.message]:
            found.states.append(msg.message)
        if msg.message == "lost":
            found.reasons.update(v.value for v in msg.values if v.key == "reason")
            if math.isnan(found.lost_after_s):
                found.lost_after_s = now_s(simulation) - DISTURBED_S

    def once() -> None:
        timer.cancel()
        disturb(simulation)

    try:
        watch.create_subscription(
            DiagnosticStatus, topics.LOCALIZATION_STATUS.name, note, 10
        )
        timer = watch.create_timer(DISTURBED_S, once)
        simulation.run()
        summary = simulation.summary()
        found.result, found.contacts = summary.goals[0].result, summary.contacts
        found.worst_m = summary.pose_error_m.worst or math.nan
        found.final_m = summary.pose_error_m.final or math.nan
        found.last_speed_mps = abs(simulation.sim.simulator.motion().linear[0])
        return found
    finally:
        simulation.close()


def now_s(simulation: Simulation) -> float:
    return simulation.context.clock.now_ns / 1e9


def after(simulation: Simulation, seconds: float, act: Callable[[], None]) -> None:
    def once() -> None:
        timer.cancel()
        act()

    timer: Timer = simulation.monitor.create_timer(seconds, once)


def carry(simulation: Simulation) -> None:
    """Put the robot 9 m to the left, turned by 86°; its wheels do not turn."""
    simulator = simulation.sim.simulator
    pose = simulator.pose().to_pose2() @ Pose2(0.0, 9.0, 1.5)
    simulator.state.place(Transform3.from_pose2(pose, z=0.07))


def jump(simulation: Simulation) -> None:
    """Shift the filter's pose by 2.2 m and 86°, as a restart of it does."""
    (ekf,) = (node for node in simulation.context.nodes if node.get_name() == "ekf")
    estimate = ekf._filter.ekf.estimate_at(ekf._filter.ekf.stamp_ns)
    pose = Pose2(*estimate.state[:3].tolist()) @ Pose2(2.0, 1.0, 1.5)
    ekf._filter.set_pose(pose, np.eye(3) * 1e-6)


def shifted(
    simulation: Simulation, north_m: float, *, count: int = 10**6, seconds: float = 1e6
) -> None:
    """Shift that many fixes, for a time."""
    (receiver,) = simulation.sim.simulator.devices[GnssSensor]
    usual, end_s, left = receiver.read, now_s(simulation) + seconds, [count]

    def read(instant: Instant, rng: np.random.Generator) -> Fix:
        fix: Fix = usual(instant, rng)
        if now_s(simulation) >= end_s or left[0] == 0:
            return fix
        left[0] -= 1
        latitude = fix.point.latitude_deg + north_m * METRE_DEG
        return replace(
            fix,
            point=GeoPoint(latitude, fix.point.longitude_deg, fix.point.altitude_m),
        )

    receiver.read = read


@pytest.mark.parametrize("disturb", [carry, jump])
@pytest.mark.parametrize("localization", FILTERS)
def test_a_wrong_pose_stops_the_robot_with_the_reason(
    localization: str, disturb: Callable[[Simulation], None]
) -> None:
    """Standing it cannot know its heading, so it stays lost."""
    found = drive(localization, disturb, max_time_s=20.0)
    assert found.states == ["localized", "lost"]
    assert found.reasons == {REASON}
    assert found.lost_after_s < 2.0
    assert found.last_speed_mps < 0.02
    assert (found.result, found.contacts) == ("unfinished", 0)


@pytest.mark.parametrize("localization", FILTERS)
def test_a_carried_robot_driven_by_hand_finds_its_pose(localization: str) -> None:
    def carry_and_drive(simulation: Simulation) -> None:
        carry(simulation)
        publisher = simulation.monitor.create_publisher(
            Twist, topics.CMD_VEL_TELEOP.name, 10
        )
        twist = Twist()
        twist.linear.x = 0.8

        def command() -> None:
            publisher.publish(twist)

        def begin() -> None:
            timer = simulation.monitor.create_timer(0.1, command)
            after(simulation, 5.0, timer.cancel)

        after(simulation, 4.0, begin)

    found = drive(localization, carry_and_drive)
    assert found.states == ["localized", "lost", "localized"]
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.final_m < 0.5


@pytest.mark.parametrize("localization", FILTERS)
def test_a_reflected_signal_stops_the_robot_until_it_ends(localization: str) -> None:
    """All fixes are 8 m beside the antenna for ten seconds."""
    found = drive(localization, lambda run: shifted(run, 8.0, seconds=10.0))
    assert found.states == ["localized", "lost", "localized"]
    assert found.reasons == {REASON}
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 0.8


@pytest.mark.parametrize("localization", FILTERS)
def test_a_single_false_fix_changes_nothing(localization: str) -> None:
    found = drive(localization, lambda run: shifted(run, 100.0, count=1))
    assert found.states == ["localized"]
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 0.8


@pytest.mark.parametrize("localization", FILTERS)
def test_twenty_seconds_without_fixes_are_dead_reckoning(localization: str) -> None:
    def silence(simulation: Simulation) -> None:
        sleepers = simulation.sim._sleepers
        timers = [timer for timer, names in sleepers if topics.FIX.name in names]
        assert timers
        for timer in timers:
            timer.cancel()

        def begin_again() -> None:
            for timer in timers:
                timer.reset()

        after(simulation, 20.0, begin_again)

    found = drive(localization, silence)
    assert found.states == ["localized"]
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 1.5
