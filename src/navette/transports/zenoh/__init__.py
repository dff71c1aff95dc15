"""Transport to other processes and machines: Zenoh with rmw_zenoh's wire format."""

from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.transport import ZenohTransport

__all__ = ["Settings", "ZenohTransport"]
