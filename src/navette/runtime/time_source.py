"""``use_sim_time``: let a node's clock follow the topic ``/clock``."""

import logging
from typing import Any

from navette.msgs.rcl_interfaces.msg import SetParametersResult
from navette.msgs.rosgraph_msgs.msg import Clock as ClockMsg
from navette.runtime.context import Context
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.node_topics import NodeTopics
from navette.runtime.parameter import Parameter, ParameterType
from navette.runtime.qos import QoSProfile, ReliabilityPolicy
from navette.runtime.ros_clock import ROSClock
from navette.runtime.subscription import Subscription
from navette.runtime.time import NS_PER_S, stamp_to_ns

_log = logging.getLogger(__name__)

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class TimeSource:
    """Controls a node's clock by the parameter ``use_sim_time``.

    Under a virtual or paced context all nodes already use simulated time, so the
    parameter is accepted and has no effect.
    """

    def __init__(
        self,
        context: Context,
        clock: ROSClock,
        parameters: NodeParameters,
        topics: NodeTopics,
    ) -> None:
        self._context = context
        self._clock = clock
        self._topics = topics
        self._invalid_logged = False
        self._subscription: Subscription[ClockMsg] | None = None
        if not parameters.has_parameter(USE_SIM_TIME_NAME):
            parameters.declare_parameter(USE_SIM_TIME_NAME, False)
        parameters.add_on_set_parameters_callback(self._check)
        parameters.add_post_set_parameters_callback(self._apply)
        self._follow(parameters.get_parameter(USE_SIM_TIME_NAME).value)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clock follows ``/clock``."""
        return self._subscription is not None

    def _check(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for parameter in parameters:
            is_bool = parameter.type_ is ParameterType.BOOL
            if parameter.name == USE_SIM_TIME_NAME and not is_bool:
                return SetParametersResult(
                    successful=False, reason="use_sim_time must be a bool"
                )
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter[Any]]) -> None:
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME:
                self._follow(parameter.value)

    def _follow(self, use_sim_time: bool) -> None:
        if self._context.clock.is_virtual or use_sim_time == self.ros_time_is_active:
            return
        if use_sim_time:
            # Time is zero until the first message, as in ROS 2.
            self._clock.set_override_ns(0)
            self._subscription = self._topics.create_subscription(
                ClockMsg, CLOCK_TOPIC, self._on_clock, _QOS, shared=True
            )
        elif self._subscription is not None:
            self._subscription.destroy()
            self._subscription = None
            self._clock.clear_override()

    def _on_clock(self, message: ClockMsg) -> None:
        time_ns = stamp_to_ns(message.clock)
        if time_ns < 0 or message.clock.nanosec >= NS_PER_S:
            if not self._invalid_logged:
                self._invalid_logged = True
                _log.warning(
                    "invalid time on %s ignored: %d s and %d ns; sec must be >= 0 and "
                    "nanosec below 1e9",
                    CLOCK_TOPIC,
                    message.clock.sec,
                    message.clock.nanosec,
                )
            return
        self._clock.set_override_ns(time_ns)
