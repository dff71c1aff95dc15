"""Service introspection: events published on ``<service>/_service_event``."""

from enum import IntEnum
from typing import Any

from navette.msgs import get_interface
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.node_topics import NodeTopics
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile
from navette.runtime.ros_clock import Clock
from navette.transports import Endpoint, RequestId


class ServiceIntrospectionState(IntEnum):
    """Content of the events; values as in rcl."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class ServiceEvents:
    """Publishes the events of one server or client after :meth:`configure`."""

    def __init__(self, endpoint: Endpoint, topics: NodeTopics) -> None:
        self._endpoint = endpoint
        self._topics = topics
        self._publisher: Publisher[Any] | None = None
        self._clock: Clock | None = None
        self._state = ServiceIntrospectionState.OFF

    def configure(
        self, clock: Clock, qos: QoSProfile, state: ServiceIntrospectionState
    ) -> None:
        """Set what is published; ``clock`` provides the stamps."""
        if self._publisher is not None:
            self._publisher.destroy()
            self._publisher = None
        self._clock, self._state = clock, state
        if state is not ServiceIntrospectionState.OFF:
            event = get_interface(f"{self._endpoint.type_name}_Event")
            topic = f"{self._endpoint.topic}/_service_event"
            self._publisher = self._topics.create_publisher(event, topic, qos)

    def report(
        self,
        event_type: int,
        request_id: RequestId,
        *,
        request: Any = None,
        response: Any = None,
    ) -> None:
        """Publish a request or response event, if introspection is on."""
        if self._publisher is None or self._clock is None:
            return
        info = ServiceEventInfo(
            event_type=event_type,
            stamp=self._clock.now().to_msg(),
            client_gid=list(request_id.client_gid),
            sequence_number=request_id.sequence,
        )
        has_contents = self._state is ServiceIntrospectionState.CONTENTS
        self._publisher.publish(
            self._publisher.msg_type(
                info=info,
                request=[request] if has_contents and request is not None else [],
                response=[response] if has_contents and response is not None else [],
            )
        )
