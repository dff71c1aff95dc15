"""Services."""

from navette.runtime.service import Service

__all__ = ["Service"]
