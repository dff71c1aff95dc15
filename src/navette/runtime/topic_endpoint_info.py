"""Results of graph queries: endpoints of topics and services."""

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Self

from navette.errors import UnknownNameError
from navette.msgs import type_hash
from navette.runtime.qos import QoSProfile, qos_profile_unknown
from navette.runtime.type_hash import TypeHash
from navette.transports import Endpoint, EndpointKind, HistoryPolicy


class EndpointTypeEnum(IntEnum):
    """Kind of an endpoint; values as in rmw."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2
    CLIENT = 3
    SERVER = 4


TopicEndpointTypeEnum = EndpointTypeEnum

_TYPES = {
    EndpointKind.PUBLISHER: EndpointTypeEnum.PUBLISHER,
    EndpointKind.SUBSCRIPTION: EndpointTypeEnum.SUBSCRIPTION,
    EndpointKind.CLIENT: EndpointTypeEnum.CLIENT,
    EndpointKind.SERVICE: EndpointTypeEnum.SERVER,
}


@dataclass
class TopicEndpointInfo:
    """Node, type and QoS of a publisher or subscription."""

    node_name: str = ""
    node_namespace: str = ""
    topic_type: str = ""
    topic_type_hash: TypeHash = field(default_factory=TypeHash)
    endpoint_type: EndpointTypeEnum = EndpointTypeEnum.INVALID
    endpoint_gid: list[int] = field(default_factory=list)
    qos_profile: QoSProfile = qos_profile_unknown

    @classmethod
    def of(cls, endpoint: Endpoint) -> Self:
        """Convert an endpoint of the graph."""
        return cls(
            node_name=endpoint.node_name,
            node_namespace=endpoint.node_namespace,
            topic_type=endpoint.type_name,
            topic_type_hash=_type_hash(endpoint),
            endpoint_type=_TYPES[endpoint.kind],
            endpoint_gid=list(endpoint.gid),
            qos_profile=QoSProfile.from_endpoint_qos(endpoint.qos),
        )

    def __str__(self) -> str:
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {_gid_text(self.endpoint_gid)}",
                *_qos_lines(self.qos_profile),
            ]
        )


@dataclass
class ServiceEndpointInfo:
    """Node, type and QoS of a server or client.

    The lists have one element. rmw implementations that use separate topics for
    requests and responses have two.
    """

    node_name: str = ""
    node_namespace: str = ""
    service_type: str = ""
    service_type_hash: TypeHash = field(default_factory=TypeHash)
    qos_profiles: list[QoSProfile] = field(default_factory=list)
    endpoint_gids: list[list[int]] = field(default_factory=list)
    endpoint_type: EndpointTypeEnum = EndpointTypeEnum.INVALID
    endpoint_count: int = 0

    @classmethod
    def of(cls, endpoint: Endpoint) -> Self:
        """Convert a server or client of the graph."""
        return cls(
            node_name=endpoint.node_name,
            node_namespace=endpoint.node_namespace,
            service_type=endpoint.type_name,
            service_type_hash=_type_hash(endpoint),
            qos_profiles=[QoSProfile.from_endpoint_qos(endpoint.qos)],
            endpoint_gids=[list(endpoint.gid)],
            endpoint_type=_TYPES[endpoint.kind],
            endpoint_count=1,
        )

    def __str__(self) -> str:
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Service type: {self.service_type}",
                f"Service type hash: {self.service_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"Endpoint count: {self.endpoint_count}",
                *(f"GID: {_gid_text(gid)}" for gid in self.endpoint_gids),
                *(line for qos in self.qos_profiles for line in _qos_lines(qos)),
            ]
        )


def _type_hash(endpoint: Endpoint) -> TypeHash:
    """Return the announced or local type hash; empty if the type is unknown."""
    try:
        return TypeHash.parse(endpoint.type_hash or type_hash(endpoint.type_name))
    except (UnknownNameError, ValueError):
        return TypeHash()  # also for peers of ROS 2 releases without type hashes


def _gid_text(gid: list[int]) -> str:
    return ".".join(f"{byte:02x}" for byte in gid)


def _qos_lines(qos: QoSProfile) -> list[str]:
    history = qos.history.name
    if qos.history == HistoryPolicy.KEEP_LAST:
        history += f" ({qos.depth})"
    return [
        "QoS profile:",
        f"  Reliability: {qos.reliability.name}",
        f"  History (Depth): {history}",
        f"  Durability: {qos.durability.name}",
        f"  Lifespan: {qos.lifespan}",
        f"  Deadline: {qos.deadline}",
        f"  Liveliness: {qos.liveliness.name}",
        f"  Liveliness lease duration: {qos.liveliness_lease_duration}",
    ]
