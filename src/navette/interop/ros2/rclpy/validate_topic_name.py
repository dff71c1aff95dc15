"""Is it a topic name?"""

from navette.runtime.names import validate_topic_name

__all__ = ["validate_topic_name"]
