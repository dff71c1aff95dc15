"""Playback of bags."""

from navette.bags.play.feed import DirectFeed, PrefetchingFeed
from navette.bags.play.merged import MergedSource, TolerantSource
from navette.bags.play.options import PlayOptions
from navette.bags.play.player import Jump, Player, PlayState
from navette.bags.play.source import Source

__all__ = [
    "PlayOptions",
    "Player",
    "PlayState",
    "Jump",
    "Source",
    "MergedSource",
    "TolerantSource",
    "DirectFeed",
    "PrefetchingFeed",
]
