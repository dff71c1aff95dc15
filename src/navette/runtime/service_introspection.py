"""Events of a service for those who watch: ``<service>/_service_event``."""

from collections.abc import Callable
from enum import IntEnum
from typing import Any

from navette.msgs import get_interface
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile
from navette.runtime.ros_clock import Clock
from navette.transports import Endpoint, RequestId

MakePublisher = Callable[[Any, str, QoSProfile], Publisher[Any]]


class ServiceIntrospectionState(IntEnum):
    """How much is told; values as in rcl."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class ServiceEvents:
    """Publishes one end's events once :meth:`configure` has switched them on."""

    def __init__(self, endpoint: Endpoint, make_publisher: MakePublisher) -> None:
        self._endpoint = endpoint
        self._make_publisher = make_publisher
        self._publisher: Publisher[Any] | None = None
        self._clock: Clock | None = None
        self._state = ServiceIntrospectionState.OFF

    def configure(
        self, clock: Clock, qos: QoSProfile, state: ServiceIntrospectionState
    ) -> None:
        """Switch on or off; ``clock`` gives the stamps."""
        if self._publisher is not None:
            self._publisher.destroy()
            self._publisher = None
        self._clock, self._state = clock, state
        if state is not ServiceIntrospectionState.OFF:
            event = get_interface(f"{self._endpoint.type_name}_Event")
            topic = f"{self._endpoint.topic}/_service_event"
            self._publisher = self._make_publisher(event, topic, qos)

    def report(
        self,
        event_type: int,
        request_id: RequestId,
        *,
        request: Any = None,
        response: Any = None,
    ) -> None:
        """Tell of a request or response, if somebody wants to know."""
        if self._publisher is None or self._clock is None:
            return
        info = ServiceEventInfo(
            event_type=event_type,
            stamp=self._clock.now().to_msg(),
            client_gid=list(request_id.client_gid),
            sequence_number=request_id.sequence,
        )
        shown = self._state is ServiceIntrospectionState.CONTENTS
        self._publisher.publish(
            self._publisher.msg_type(
                info=info,
                request=[request] if shown and request is not None else [],
                response=[response] if shown and response is not None else [],
            )
        )
