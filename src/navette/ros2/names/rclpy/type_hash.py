"""Hashes of types."""

from navette.runtime.type_hash import TypeHash

__all__ = ["TypeHash"]
