"""Is it a full topic name?"""

from navette.runtime.names import validate_full_topic_name

__all__ = ["validate_full_topic_name"]
