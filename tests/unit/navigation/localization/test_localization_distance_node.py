import math

import pytest

from navette.errors import ParameterError
from navette.msgs.geometry_msgs.msg import TwistStamped
from navette.msgs.gnss_driver.msg import Gps
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import NavSatFix
from navette.navigation.localization.distance.node import OdomIntegratorNode
from navette.runtime import Parameter, ns_to_stamp
from navette.runtime.testing import GraphHarness, Probe

SECOND = 1_000_000_000
DISTANCE = "/odom_integrator/distance"


def gps(stamp_ns: int, x: float, speed: float = 0.0) -> Gps:
    msg = Gps()
    msg.header.stamp = ns_to_stamp(stamp_ns)
    msg.localization.position.x = x
    msg.localization.position.y = 5e6
    msg.localization.linear_velocity.y = speed
    return msg


def started(graph: GraphHarness, **values) -> tuple[OdomIntegratorNode, Probe]:
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = OdomIntegratorNode(context=graph.context, parameter_overrides=overrides)
    return graph.add(node), graph.collect(DISTANCE, "std_msgs/msg/Float64")


def test_zero_is_published_ten_times_a_second_before_the_first_message() -> None:
    with GraphHarness() as graph:
        _, distances = started(graph)
        graph.run_for(1.05)
        assert [msg.data for msg in distances.messages] == [0.0] * 10


@pytest.mark.parametrize(("odom_type", "metres"), [("pos", 4), ("gps", 4), ("vel", 6)])
def test_the_distance_by_position_or_velocity(odom_type: str, metres: float) -> None:
    with GraphHarness() as graph:
        _, distances = started(graph, odom_type=odom_type)
        for second in range(3):
            message = gps(second * SECOND, 2.0 * second, speed=3.0)
            graph.publish("/gnss_driver/odometry", message)
            graph.run_for(0.05)  # a queue of one: the newest counts
        graph.run_for(0.2)
        assert distances.last.data == pytest.approx(metres)


def test_another_odom_type_is_an_error_that_lists_them() -> None:
    with (
        GraphHarness() as graph,
        pytest.raises(ParameterError, match=r"'speed'.*one of pos, gps, vel"),
    ):
        started(graph, odom_type="speed")


def test_a_type_without_the_summed_quantity_is_an_error() -> None:
    with GraphHarness() as graph:
        with pytest.raises(ParameterError, match="NavSatFix has no velocity"):
            started(graph, odom_type="vel", topic_type="sensor_msgs/msg/NavSatFix")
        with pytest.raises(ParameterError, match="TwistStamped has no position"):
            started(graph, topic_type="geometry_msgs/msg/TwistStamped")


def fix(stamp_ns: int, latitude: float, status: int = 0) -> NavSatFix:
    msg = NavSatFix(latitude=latitude, longitude=11.0, altitude=math.nan)
    msg.header.stamp = ns_to_stamp(stamp_ns)
    msg.status.status = status
    return msg


def test_fixes_are_summed_by_the_geodesic_and_no_fix_is_skipped() -> None:
    with GraphHarness() as graph:
        kind = "sensor_msgs/msg/NavSatFix"
        _, distances = started(graph, topic="/fix", topic_type=kind)
        for message in (fix(0, 0.0), fix(SECOND, 9.0, -1), fix(2 * SECOND, 0.001)):
            graph.publish("/fix", message)
            graph.run_for(0.05)
        graph.run_for(0.2)
        assert distances.last.data == pytest.approx(110.5743, abs=1e-3)


@pytest.mark.parametrize("kind", [TwistStamped, Odometry])
def test_other_types_that_carry_a_velocity(kind: type) -> None:
    with GraphHarness() as graph:
        name = {"TwistStamped": "geometry", "Odometry": "nav"}[kind.__name__]
        _, distances = started(
            graph,
            odom_type="vel",
            topic="odom",
            topic_type=f"{name}_msgs/msg/{kind.__name__}",
        )
        for second in range(3):
            message = kind()
            message.header.stamp = ns_to_stamp(second * SECOND)
            twist = message.twist if kind is TwistStamped else message.twist.twist
            twist.linear.x = 1.5
            graph.publish("/odom", message)
            graph.run_for(0.05)
        graph.run_for(0.2)
        assert distances.last.data == pytest.approx(3.0)


def test_parameters_change_while_running_except_the_topic() -> None:
    with GraphHarness() as graph:
        node, _ = started(graph)
        for stamp, x in ((0, 0.0), (SECOND, 1.0)):
            node.on_message(gps(stamp, x, speed=9.0))
        assert node.set_parameters([Parameter("odom_type", value="vel")])[0].successful
        node.on_message(gps(2 * SECOND, 2.0, speed=9.0))
        assert node.distance == 1.0
        node.on_message(gps(3 * SECOND, 3.0, speed=9.0))
        assert node.distance == pytest.approx(10.0)
        (refused,) = node.set_parameters([Parameter("topic", value="/other")])
        assert "cannot change after the start" in refused.reason


def test_jumps_are_logged_and_add_nothing() -> None:
    with GraphHarness() as graph:
        node, _ = started(graph)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        for second, x in ((10, 0.0), (11, 1.0), (5, 50.0), (60, 900.0)):
            node.on_message(gps(second * SECOND, x))
        graph.publish("/gnss_driver/odometry", gps(61 * SECOND, math.nan))
        graph.run_for(0.1)
        assert node.distance == 1.0
        assert node.dropped_inputs == {("/gnss_driver/odometry", "not_finite"): 1}
        texts = [log.msg for log in logs.messages]
        assert texts == [
            "time went back: counting continues from 5.000 s",
            "gap in time: counting continues from 60.000 s",
            "refused /gnss_driver/odometry: not_finite: (nan, 5000000.0, 0.0); must be "
            "finite numbers (more of this kind are only counted, on /diagnostics)",
        ]


@pytest.mark.parametrize(("depth", "metres"), [(1, 2.0), (3, 4.0)])
def test_a_longer_queue_keeps_the_bends_of_a_burst(depth: int, metres: float) -> None:
    with GraphHarness() as graph:
        _, distances = started(graph, queue_size=depth)
        graph.publish("/gnss_driver/odometry", gps(0, 0.0))
        graph.run_for(0.05)
        for second, x in ((1, 3.0), (2, 2.0)):
            graph.publish("/gnss_driver/odometry", gps(second * SECOND, x))
        graph.run_for(0.2)
        assert distances.last.data == pytest.approx(metres)
