"""``navette interface``: definitions of messages, services and actions."""

from navette.cli.interface.verbs import interface

__all__ = ["interface"]
