"""Who publishes and who reads."""

from navette.runtime.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]
