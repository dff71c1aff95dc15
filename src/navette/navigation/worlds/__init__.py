"""Worlds by name, file, or kind and seed."""

from navette.navigation.worlds.loading import load_scene

__all__ = ["load_scene"]
