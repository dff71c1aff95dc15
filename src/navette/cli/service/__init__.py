"""``navette service``: list, inspect, print and call services."""

from navette.cli.service.verbs import service

__all__ = ["service"]
