"""``navette bag …``: recordings."""

from navette.cli.bag.app import bag

__all__ = ["bag"]
