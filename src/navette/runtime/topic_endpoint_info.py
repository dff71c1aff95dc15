"""Publishers and subscriptions as graph queries list them."""

from enum import IntEnum

from navette.errors import UnknownNameError
from navette.msgs import type_hash
from navette.runtime.qos import QoSProfile
from navette.runtime.type_hash import TypeHash
from navette.transports import Endpoint, HistoryPolicy


class TopicEndpointTypeEnum(IntEnum):
    """What an endpoint does; values as in rmw."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


class TopicEndpointInfo:
    """Whose endpoint it is, of which type, with which QoS."""

    def __init__(self, endpoint: Endpoint) -> None:
        self.node_name = endpoint.node_name
        self.node_namespace = endpoint.node_namespace
        self.topic_type = endpoint.type_name
        self.endpoint_type = TopicEndpointTypeEnum(endpoint.kind.value)
        self.endpoint_gid = list(endpoint.gid)
        self.qos_profile = QoSProfile.from_endpoint_qos(endpoint.qos)
        self._type_hash = endpoint.type_hash

    @property
    def topic_type_hash(self) -> TypeHash:
        """Unknown where nothing here defines the type."""
        try:
            return TypeHash.parse(self._type_hash or type_hash(self.topic_type))
        except (UnknownNameError, ValueError):
            return TypeHash()  # or announced by a release that knew no hashes

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TopicEndpointInfo):
            return NotImplemented
        return vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return (
            f"TopicEndpointInfo(node={self.node_namespace.rstrip('/')}/"
            f"{self.node_name}, {self.endpoint_type.name}, {self.topic_type})"
        )

    def __str__(self) -> str:
        qos = self.qos_profile
        history = qos.history.name
        if qos.history == HistoryPolicy.KEEP_LAST:
            history += f" ({qos.depth})"
        gid = ".".join(f"{byte:02x}" for byte in self.endpoint_gid)
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {gid}",
                "QoS profile:",
                f"  Reliability: {qos.reliability.name}",
                f"  History (Depth): {history}",
                f"  Durability: {qos.durability.name}",
                f"  Lifespan: {qos.lifespan}",
                f"  Deadline: {qos.deadline}",
                f"  Liveliness: {qos.liveliness.name}",
                f"  Liveliness lease duration: {qos.liveliness_lease_duration}",
            ]
        )
