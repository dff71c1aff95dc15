"""Reliable samples that were lost on the way come still, between Navette's sessions."""

from navette.transports.zenoh.recovery.answer import Recovered
from navette.transports.zenoh.recovery.arrivals import Arrivals
from navette.transports.zenoh.recovery.hub import Recovery
from navette.transports.zenoh.recovery.retention import Retention
from navette.transports.zenoh.recovery.wants import Wants

__all__ = ["Arrivals", "Recovered", "Recovery", "Retention", "Wants"]
