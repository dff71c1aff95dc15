"""Is it a topic name?"""

from navette.runtime.exceptions import (
    InvalidServiceNameException,
    InvalidTopicNameException,
)
from navette.runtime.names import TOPIC_SEPARATOR_STRING, validate_topic_name

__all__ = [
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "TOPIC_SEPARATOR_STRING",
    "validate_topic_name",
]
