"""``use_sim_time``: a node's clock follows ``/clock`` where no simulator is inside."""

from typing import TYPE_CHECKING, Any

from navette.msgs.rcl_interfaces.msg import SetParametersResult
from navette.msgs.rosgraph_msgs.msg import Clock as ClockMsg
from navette.runtime.parameter import Parameter, ParameterType
from navette.runtime.qos import QoSProfile, ReliabilityPolicy
from navette.runtime.ros_clock import ROSClock
from navette.runtime.time import stamp_to_ns

if TYPE_CHECKING:
    from navette.runtime.node import Node
    from navette.runtime.subscription import Subscription

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class TimeSource:
    """Switches a node's clock by the node's parameter ``use_sim_time``.

    Under a virtual or paced context, time is simulated already and every node is on
    it: the parameter is accepted and changes nothing.
    """

    def __init__(self, node: "Node") -> None:
        self._node = node
        self._subscription: Subscription[ClockMsg] | None = None
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)
        self._switch(node.get_parameter(USE_SIM_TIME_NAME).value)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether ``/clock`` is listened to."""
        return self._subscription is not None

    def _check(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for parameter in parameters:
            wrong = parameter.type_ is not ParameterType.BOOL
            if parameter.name == USE_SIM_TIME_NAME and wrong:
                return SetParametersResult(
                    successful=False, reason="use_sim_time must be a bool"
                )
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter[Any]]) -> None:
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME:
                self._switch(parameter.value)

    def _switch(self, wanted: bool) -> None:
        if self._node.context.clock.is_virtual or wanted == self.ros_time_is_active:
            return
        clock = self._node.get_clock()
        assert isinstance(clock, ROSClock), "a node's clock is a ROSClock"
        if wanted:
            # Time is zero until the first message, as in ROS 2.
            clock.set_override_ns(0)
            self._subscription = self._node.create_subscription(
                ClockMsg, CLOCK_TOPIC, self._on_clock, _QOS, shared=True
            )
        elif self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
            clock.clear_override()

    def _on_clock(self, message: ClockMsg) -> None:
        clock = self._node.get_clock()
        assert isinstance(clock, ROSClock), "a node's clock is a ROSClock"
        clock.set_override_ns(stamp_to_ns(message.clock))
