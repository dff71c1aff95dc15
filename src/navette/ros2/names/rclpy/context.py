"""Contexts."""

from navette.runtime.context import Context, get_default_context

__all__ = ["Context", "get_default_context"]
