"""Lock-step between processes: counts of sent samples, samples buffered for a step."""

from navette.transports.lockstep.records import (
    MAX_BYTES,
    Sent,
    StepGrant,
    StepReport,
    parse_grant,
    parse_report,
)
from navette.transports.lockstep.sample_buffer import (
    BufferedSubscription,
    Missing,
    SampleBuffer,
    SubscriptionInfo,
)
from navette.transports.lockstep.sent_counter import PublisherCount, SentCounter
from navette.transports.lockstep.wire import Participants, StepTraffic, StepWire

__all__ = [
    "MAX_BYTES",
    "BufferedSubscription",
    "StepGrant",
    "Missing",
    "Participants",
    "StepReport",
    "SampleBuffer",
    "Sent",
    "PublisherCount",
    "SentCounter",
    "StepTraffic",
    "StepWire",
    "SubscriptionInfo",
    "parse_grant",
    "parse_report",
]
