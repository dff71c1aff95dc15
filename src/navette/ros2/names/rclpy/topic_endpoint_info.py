"""Who publishes and who reads."""

from navette.runtime.qos import QoSHistoryPolicy, QoSPresetProfiles, QoSProfile
from navette.runtime.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from navette.runtime.type_hash import TypeHash

__all__ = [
    "QoSHistoryPolicy",
    "QoSPresetProfiles",
    "QoSProfile",
    "TopicEndpointInfo",
    "TopicEndpointTypeEnum",
    "TypeHash",
]
