"""The noise of the parameters is the one that messages state."""

from navette.msgs.sensor_msgs.msg import Imu
from navette.navigation.stack.robot import simulate_robot
from navette.runtime import Context, Executor, Node, VirtualClock


def variance(**values: object) -> float:
    """Return the variance of the turn rate in the IMU's message."""
    context, received = Context(clock=VirtualClock()), list[Imu]()
    with context:
        context.overrides.add("sim", values, "test")
        simulate_robot("empty", "jackal", context=context)
        node = Node("listener", context=context)
        node.create_subscription(Imu, "/imu", received.append, 10)
        executor = Executor(context=context)
        for each in context.nodes:
            executor.add_node(each)
        executor.spin_until(100_000_000)
        return float(received[-1].angular_velocity_covariance[8])


def test_the_message_states_the_variance_of_the_parameter() -> None:
    assert variance(imu_turn_rate_noise_radps=0.02) == 0.02**2


def test_without_truth_a_gyroscope_has_noise() -> None:
    assert variance(localization="odometry+imu") > 0.0
    assert variance(localization="odometry+imu", imu_turn_rate_noise_radps=0.0) == 0.0
