"""A filter that its sensors contradict: the robot stops and reports it is lost."""

import math

import pytest

from navette.geometry import Pose2, Transform3
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation

CARRIED_M = 15.0
SEEN_S = 12.0  # after the robot was carried, with a fix every 0.2 s


@pytest.mark.long
def test_a_carried_robot_with_gnss_stops_and_reports_the_reason() -> None:
    """Far beyond the noise of the receiver, which the filter trusts little."""
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=Pose2(0.0, 0.0, 0.0),
        goals=((20.0, 0.0),),
        headless=True,
        speed=math.inf,
        methods={"localization": "odometry+imu+gnss"},
        max_time_s=4.0 + SEEN_S,
    )
    simulation = Simulation(options)
    states: list[str] = []
    reasons: set[str] = set()
    speeds: list[float] = []

    def note(msg: DiagnosticStatus) -> None:
        if states[-1:] != [msg.message]:
            states.append(msg.message)
        if msg.message == "lost":
            reasons.update(each.value for each in msg.values if each.key == "reason")
            speeds.append(abs(simulation.sim.simulator.motion().linear[0]))

    def carry() -> None:
        timer.cancel()
        pose = simulation.sim.simulator.pose().to_pose2() @ Pose2(0.0, CARRIED_M, 0.0)
        place = Transform3.from_pose2(pose, z=0.07)
        simulation.sim.simulator.state.place(place)

    try:
        watch = simulation.monitor
        watch.create_subscription(DiagnosticStatus, "/localization/status", note, 10)
        timer = watch.create_timer(4.0, carry)
        simulation.run()
        assert states[:2] == ["localized", "lost"]
        assert reasons == {"gps0 contradicts the estimate"}
        assert speeds[-1] < 0.02
        assert simulation.monitor.progress.state == "lost"
        assert simulation.summary().goals[0].result != "reached"
    finally:
        simulation.close()
