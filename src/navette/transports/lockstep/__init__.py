"""Lock-step between processes: who sent what, and samples held until a step begins."""

from navette.transports.lockstep.held import HeldSamples, Holding, Missing
from navette.transports.lockstep.records import (
    MOST_BYTES,
    Grant,
    Report,
    Sent,
    parse_grant,
    parse_report,
)
from navette.transports.lockstep.tally import SentTally
from navette.transports.lockstep.wire import Census, StepTraffic, StepWire

__all__ = [
    "MOST_BYTES",
    "Census",
    "Grant",
    "HeldSamples",
    "Holding",
    "Missing",
    "Report",
    "Sent",
    "SentTally",
    "StepTraffic",
    "StepWire",
    "parse_grant",
    "parse_report",
]
