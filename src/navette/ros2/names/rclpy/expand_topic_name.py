"""Relative and private names made full."""

from navette.runtime.names import expand_topic_name

__all__ = ["expand_topic_name"]
