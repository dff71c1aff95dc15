"""Who publishes, reads, serves and calls."""

from navette.runtime.topic_endpoint_info import (
    EndpointTypeEnum,
    ServiceEndpointInfo,
    TopicEndpointInfo,
)

__all__ = [
    "EndpointTypeEnum",
    "ServiceEndpointInfo",
    "TopicEndpointInfo",
]
