"""Endpoints of other processes and machines, over Zenoh as rmw_zenoh uses it."""

from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.transport import ZenohTransport

__all__ = ["Settings", "ZenohTransport"]
