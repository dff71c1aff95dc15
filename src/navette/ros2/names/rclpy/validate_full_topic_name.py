"""Is it a full topic name?"""

from navette.runtime.exceptions import (
    InvalidServiceNameException,
    InvalidTopicNameException,
)
from navette.runtime.names import validate_full_topic_name

__all__ = [
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "validate_full_topic_name",
]
