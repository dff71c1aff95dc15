"""When the filter is lost: contradicting sensors, uncertainty, silence."""

import numpy as np
import pytest
from test_localization_ekf_node import (
    WHEELS,
    fix,
    initial_pose,
    placed,
    started,
    wheels,
)

from navette.geometry import Transform3
from navette.navigation.localization.ekf.consistency import (
    ConsistencyMonitor,
    FilterState,
)
from navette.navigation.localization.ekf.filter import Innovation
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.state import SIZE
from navette.runtime.testing import GraphHarness

SECOND = 1_000_000_000
POSITION, VELOCITY = (0, 1), (3, 4, 5)
LOST, LOCALIZED = FilterState.LOST, FilterState.LOCALIZED
METRE_DEG = 1 / 111_195.0  # of latitude


def noted(
    monitor: ConsistencyMonitor,
    source: str,
    squared: float,
    stamp_ns: int,
    indices: tuple[int, ...] = VELOCITY,
    difference_m: tuple[float, float] = (0.0, 0.0),
) -> None:
    """Note a measurement of 1 m of noise, far less certain than the estimate."""
    count = len(indices)
    noise, of_estimate = np.eye(count), 1e-4 * np.eye(count)
    difference = np.array([*difference_m, 0.0])[:count]
    seen = Measurement(source, stamp_ns, indices, np.zeros(count), noise)
    state = np.zeros(SIZE)
    monitor.note(seen, Innovation(state, difference, noise + of_estimate, squared))


@pytest.mark.parametrize(("entries", "bound"), [(1, 10.83), (2, 13.82), (3, 16.27)])
def test_a_consistent_sensor_exceeds_the_bound_once_in_a_thousand(
    entries: int, bound: float
) -> None:
    drawn = np.random.default_rng(0).chisquare(entries, 200_000)
    assert (drawn > bound).mean() == pytest.approx(0.001, abs=0.0003)
    monitor = ConsistencyMonitor(SECOND, 5.0)
    for squared, expected in ((bound - 0.01, LOCALIZED), (bound + 0.01, LOST)):
        for second in range(4):
            noted(monitor, "imu0", squared, second * SECOND, VELOCITY[:entries])
        assert monitor.update(0.1, 3 * SECOND) is expected


def test_outliers_do_not_count() -> None:
    monitor = ConsistencyMonitor(SECOND, 5.0)
    for number in range(100):
        squared = 1.0 if number % 10 == 9 else 1e3
        noted(monitor, "gps0", squared, number * SECOND // 10, POSITION)
        assert monitor.update(0.1, number * SECOND // 10) is LOCALIZED


def test_one_sensor_is_enough_and_is_named() -> None:
    monitor = ConsistencyMonitor(2 * SECOND, 5.0)
    for number in range(30):
        noted(monitor, "odom0", 1.0, number * SECOND // 10)
        noted(monitor, "gps0", 1e3, number * SECOND // 10, POSITION)
    assert monitor.update(0.1, 3 * SECOND) is LOST
    assert monitor.cause == "gps0 contradicts the estimate"
    noted(monitor, "gps0", 1.0, 3 * SECOND, POSITION)
    assert monitor.update(0.1, 3 * SECOND) is LOCALIZED
    assert monitor.update(5.1, 3 * SECOND) is LOST
    assert monitor.cause == "the position is too uncertain"


def medians(monitor: ConsistencyMonitor, offset_m: float, since_s: int) -> FilterState:
    """Note 20 s of positions with 1 m of noise beside the estimate; five a second."""
    rng = np.random.default_rng(since_s)
    for number in range(since_s * 5, (since_s + 20) * 5):
        x, y = rng.normal((offset_m, 0.0))
        stamp_ns = number * SECOND // 5
        noted(monitor, "gps0", x * x + y * y, stamp_ns, POSITION, (x, y))
        state = monitor.update(0.1, stamp_ns)
    return state


def test_the_median_shows_an_offset_that_single_positions_do_not() -> None:
    """Beyond 13.8, the square of 3.7 m, one in 40 of these positions would be."""
    monitor = ConsistencyMonitor(3 * SECOND, 5.0)
    assert medians(monitor, 0.0, 0) is LOCALIZED
    assert medians(monitor, 2.5, 20) is LOST
    assert monitor.contradicts("gps0")
    assert medians(monitor, 0.0, 40) is LOCALIZED
    assert not monitor.contradicts("gps0")


def test_the_median_of_a_consistent_sensor_agrees_for_an_hour() -> None:
    monitor, rng = ConsistencyMonitor(3 * SECOND, 5.0), np.random.default_rng(0)
    states = set()
    for number in range(18_000):
        x, y = rng.standard_normal(2)
        stamp_ns = number * SECOND // 5
        noted(monitor, "gps0", x * x + y * y, stamp_ns, POSITION, (x, y))
        states.add(monitor.update(0.1, stamp_ns))
    assert states == {LOCALIZED}


def test_a_few_outliers_do_not_move_the_median() -> None:
    monitor, rng = ConsistencyMonitor(3 * SECOND, 5.0), np.random.default_rng(6)
    for number in range(1500):
        x, y = rng.standard_normal(2) + (number % 5 == 0) * rng.uniform(-50, 50, 2)
        noted(monitor, "gps0", x * x + y * y, number * SECOND // 5, POSITION, (x, y))
        assert monitor.update(0.1, number * SECOND // 5) is LOCALIZED


def test_a_filter_that_a_position_contradicts_is_lost_until_it_is_set() -> None:
    """The robot is carried 20 m north while the wheels report that it stands."""
    with GraphHarness() as graph:
        given = {"gps0": "/fix", "gps0_datum_deg": [45.0, 5.0]}
        noise = [
            1e-4,
            1e-4,
            0.0,
            0.0,
            0.0,
            1e-4,
            0.5,
            0.01,
            0.0,
            0.0,
            0.0,
            0.5,
            *[0.0] * 3,
        ]
        given["process_noise_covariance"] = noise
        started(graph, **WHEELS, **given, lost_time_s=2.0)
        placed(graph, "antenna", Transform3.identity())
        found = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus"
        )
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")

        def stand(since_s: float, north_m: float, seconds: float) -> list[str]:
            found.messages.clear()
            for number in range(round(seconds * 10)):
                stamp_s = since_s + number / 10
                graph.publish("/wheels", wheels(stamp_s, 0.0))
                if number % 2 == 0:
                    latitude = 45.0 + north_m * METRE_DEG
                    graph.publish("/fix", fix(stamp_s, latitude, 5.0))
                graph.run_for(0.1)
            return list(dict.fromkeys(msg.message for msg in found.messages))

        assert stand(0.0, 0.0, 5.0) == [LOCALIZED]
        assert stand(5.0, 20.0, 4.0) == [LOCALIZED, LOST]
        values = {each.key: each.value for each in found.last.values}
        assert values["reason"] == "gps0 contradicts the estimate"
        assert any("lost: gps0 contradicts" in log.msg for log in logs.messages)
        graph.publish("/initialpose", initial_pose(0.0, 20.0, 0.0))
        graph.run_for(0.01)
        assert stand(9.0, 20.0, 3.0) == [LOCALIZED]


def test_an_uncertain_position_is_lost_if_a_sensor_measures_it() -> None:
    with GraphHarness() as graph:
        noise = [0.5, 0.5, *[0.0] * 13]
        given = {"gps0": "/fix", "process_noise_covariance": noise}
        started(graph, **WHEELS, **given, lost_stddev_m=1.0)
        found = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus"
        )
        graph.publish("/fix", fix(0.0, 45.0, 5.0))
        for number in range(60):
            graph.publish("/wheels", wheels(number / 10, 0.0))
            graph.run_for(0.1)
        states = list(dict.fromkeys(msg.message for msg in found.messages))
        assert states == [LOCALIZED, LOST]


def test_dead_reckoning_is_not_lost_by_its_drift_but_without_measurements() -> None:
    with GraphHarness() as graph:
        noise = [0.5, 0.5, *[0.0] * 13]
        started(graph, **WHEELS, process_noise_covariance=noise, lost_stddev_m=1.0)
        found = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus"
        )
        for number in range(60):
            graph.publish("/wheels", wheels(number / 10, 0.0))
            graph.run_for(0.1)
        assert {msg.message for msg in found.messages} == {LOCALIZED}
        graph.run_for(1.0)
        assert found.last.message == LOST
        assert found.last.values[0].value == "no measurement arrives"


def test_beside_another_localization_nothing_is_reported() -> None:
    with GraphHarness() as graph:
        started(graph, **WHEELS, publish_status=False)
        found = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus"
        )
        graph.publish("/wheels", wheels(0.0, 0.0))
        graph.run_for(2.0)
        assert found.count == 0
