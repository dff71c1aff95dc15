"""``navette action …``: who serves which actions; and sending goals."""

from navette.cli.action.verbs import action

__all__ = ["action"]
