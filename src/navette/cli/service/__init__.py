"""``navette service …``: who serves what; and calling it."""

from navette.cli.service.verbs import service

__all__ = ["service"]
