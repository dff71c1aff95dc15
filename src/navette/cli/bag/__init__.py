"""``navette bag``: record, play, inspect, repair and edit recordings."""

from navette.cli.bag.verbs import bag

__all__ = ["bag"]
