"""Clients of services."""

from navette.runtime.client import Client

__all__ = ["Client"]
