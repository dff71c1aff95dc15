"""Lifespans of remote publishers, known before or after their samples arrive."""

from typing import Any

import pytest

from navette.transports import Endpoint, EndpointKind, EndpointQos, Expiring
from navette.transports.expiring import Lifespans

GID = b"g" * 16
S = 10**9
SINCE_1970 = 1_800_000_000 * S


class Case:
    """A publisher with a lifespan and the warnings about it."""

    def __init__(self, lifespan_ns: int) -> None:
        self.publisher = Endpoint(
            EndpointKind.PUBLISHER,
            "/news",
            "std_msgs/msg/String",
            EndpointQos(lifespan_ns=lifespan_ns),
            "talker",
            "/",
            GID,
            "RIHS01_0",
        )
        self.known = {GID: self.publisher}
        self.warnings: list[str] = []
        self.lifespans = Lifespans(
            self.known, on_expired=lambda _, text: self.note(text)
        )

    def note(self, text: str) -> None:
        self.warnings.append(text)

    def sent(self, source_ns: int, received_ns: int) -> Any:
        item = ("text", source_ns, received_ns, 7)
        message, *rest = self.lifespans.limited(GID, item)
        assert rest == [source_ns, received_ns, 7]
        return message


@pytest.mark.parametrize("lifespan_ns", [0, 2**63 - 1])
def test_samples_without_a_lifespan_do_not_expire(lifespan_ns: int) -> None:
    """Some peers announce zero for no lifespan."""
    case = Case(lifespan_ns)
    assert case.sent(1, 2) == "text"
    case.known.clear()
    early = case.sent(1, 2)
    case.known[GID] = case.publisher
    assert early.at(10 * S) == "text"


def test_the_lifespan_begins_at_the_source_stamp() -> None:
    message = Case(2 * S).sent(5 * S, 6 * S)
    assert isinstance(message, Expiring)
    assert message.at(7 * S - 1) == "text"
    assert message.at(7 * S) is None


def test_an_early_sample_expires_once_its_publisher_is_known() -> None:
    case = Case(2 * S)
    case.known.clear()
    message = case.sent(5 * S, 6 * S)
    assert message.at(99 * S) == "text"
    case.known[GID] = case.publisher
    assert message.at(6 * S) == "text"
    assert message.at(7 * S) is None


@pytest.mark.parametrize(
    ("source_ns", "received_ns"), [(5 * S, SINCE_1970), (SINCE_1970, 5 * S)]
)
def test_two_different_clocks_are_not_compared(
    source_ns: int, received_ns: int
) -> None:
    """The age is then the time since the sample arrived."""
    case = Case(2 * S)
    message = case.sent(source_ns, received_ns)
    assert message.at(received_ns + 2 * S - 1) == "text"
    assert message.at(received_ns + 2 * S) is None
    assert case.warnings == []


def test_samples_that_expired_on_arrival_cause_a_warning() -> None:
    case = Case(10 * S)
    for second in range(3):  # at first the samples could be history
        assert case.warnings == []
        now_ns = SINCE_1970 + second * S
        assert case.sent(now_ns - 35 * S, now_ns).at(now_ns) is None
    (text,) = case.warnings
    assert text.startswith("messages of /talker are dropped: they are 35 s old")
    assert "lifespan of 10 s" in text
