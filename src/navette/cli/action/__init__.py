"""``navette action``: list and inspect actions, and send goals."""

from navette.cli.action.verbs import action

__all__ = ["action"]
