"""Common base of service servers and clients."""

from typing import Any

from navette.msgs import get_interface
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.destroyable import Destroyable
from navette.runtime.qos import QoSProfile
from navette.runtime.ros_clock import Clock
from navette.runtime.service_introspection import (
    ServiceEvents,
    ServiceIntrospectionState,
)
from navette.transports import Endpoint


class ServiceEndpoint(Destroyable):
    """A server or client of a service: names, type and introspection."""

    __slots__ = ()

    endpoint: Endpoint
    srv_name: str
    group: CallbackGroup
    _events: ServiceEvents

    @property
    def srv_type(self) -> Any:
        # Looked up on use: creating the classes of a node's parameter services would
        # be most of the cost of the first node.
        return get_interface(self.endpoint.type_name)

    @property
    def service_name(self) -> str:
        """The full name; ``srv_name`` is the one that the program gave."""
        return self.endpoint.topic

    @property
    def callback_group(self) -> CallbackGroup:
        return self.group

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish requests and responses on ``<service>/_service_event``, or stop."""
        self._events.configure(clock, service_event_qos_profile, introspection_state)
