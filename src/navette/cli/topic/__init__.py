"""``navette topic``: list, inspect, print, measure and publish topics."""

from navette.cli.topic.verbs import topic

__all__ = ["topic"]
