"""``navette bag …``: record, look into, repair and rework recordings."""

from navette.cli.bag.app import bag

__all__ = ["bag"]
