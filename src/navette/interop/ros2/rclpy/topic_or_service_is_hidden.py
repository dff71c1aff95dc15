"""Is it a hidden name?"""

from navette.runtime.names import topic_or_service_is_hidden

__all__ = ["topic_or_service_is_hidden"]
