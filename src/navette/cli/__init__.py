"""The command line: ``navette demo``, ``navette sim``."""

from navette.cli.app import main

__all__ = ["main"]
