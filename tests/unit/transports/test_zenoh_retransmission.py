"""Which endpoints resend lost samples."""

from dataclasses import replace

import pytest

from navette.errors import InvalidValueError
from navette.transports import EndpointQos, ReliabilityPolicy
from navette.transports.zenoh.retransmission import retransmits
from navette.transports.zenoh.settings import Settings

RELIABLE = EndpointQos()
LATCHED = EndpointQos.latched()
BEST_EFFORT = EndpointQos(reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.mark.parametrize(
    ("qos", "topic", "setting", "expected"),
    [
        (RELIABLE, "/goal", "", False),
        (LATCHED, "/map", "", True),
        (RELIABLE, "/goal", "/goal", True),
        (RELIABLE, "/arm/goal", "/goal, /arm/*", True),
        (RELIABLE, "/arm", "/arm/*", False),
        (RELIABLE, "/anything", "*", True),
        (BEST_EFFORT, "/goal", "*", False),
        (replace(BEST_EFFORT, durability=LATCHED.durability), "/map", "", False),
    ],
)
def test_reliable_endpoints_retransmit_if_latched_or_listed(
    qos: EndpointQos, topic: str, setting: str, expected: bool
) -> None:
    patterns = Settings.from_environment({"NAVETTE_RETRANSMIT": setting}).retransmit
    assert retransmits(qos, topic, patterns) is expected


def test_a_topic_without_its_namespace_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="NAVETTE_RETRANSMIT: 'goal' is not a"):
        Settings.from_environment({"NAVETTE_RETRANSMIT": "/map, goal"})
