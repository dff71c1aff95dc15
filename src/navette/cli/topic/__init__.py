"""``navette topic …``: what is said on topics, by whom, how often; and saying it."""

from navette.cli.topic.app import topic

__all__ = ["topic"]
