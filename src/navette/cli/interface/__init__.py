"""``navette interface …``: what messages, services and actions are made of."""

from navette.cli.interface.app import interface

__all__ = ["interface"]
