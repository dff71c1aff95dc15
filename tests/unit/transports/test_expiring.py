"""Lifespans of publishers in other processes: what is known of them, and when."""

from typing import Any

import pytest

from navette.transports import Endpoint, EndpointKind, EndpointQos, Expiring
from navette.transports.expiring import Lifespans

GID = b"g" * 16
S = 10**9
SINCE_1970 = 1_800_000_000 * S


class Case:
    """A publisher, known or not yet, and what comes of it."""

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
        self.complaints: list[str] = []
        self.lifespans = Lifespans(self.known, lambda _, text: self.note(text))

    def note(self, text: str) -> None:
        self.complaints.append(text)

    def sent(self, source_ns: int, received_ns: int) -> Any:
        item = ("text", source_ns, received_ns, 7)
        message, *rest = self.lifespans.limited(GID, item)
        assert rest == [source_ns, received_ns, 7]
        return message


@pytest.mark.parametrize("lifespan_ns", [0, 2**63 - 1])
def test_without_a_lifespan_nothing_is_wrapped(lifespan_ns: int) -> None:
    """Zero is how some write that there is none."""
    case = Case(lifespan_ns)
    assert case.sent(1, 2) == "text"
    case.known.clear()
    early = case.sent(1, 2)
    case.known[GID] = case.publisher
    assert early.at(10 * S) == "text"


def test_it_counts_from_the_sending() -> None:
    message = Case(2 * S).sent(5 * S, 6 * S)
    assert isinstance(message, Expiring)
    assert message.at(7 * S - 1) == "text"
    assert message.at(7 * S) is None


def test_what_comes_before_its_publisher_is_known_expires_once_it_is() -> None:
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
def test_clocks_of_two_worlds_do_not_compare(source_ns: int, received_ns: int) -> None:
    """A simulation's time and the machine's: it is as old as it waited here."""
    case = Case(2 * S)
    message = case.sent(source_ns, received_ns)
    assert message.at(received_ns + 2 * S - 1) == "text"
    assert message.at(received_ns + 2 * S) is None
    assert case.complaints == []


def test_clocks_that_differ_by_more_than_the_lifespan_are_complained_about() -> None:
    case = Case(10 * S)
    for second in range(3):  # at first it could be a history
        assert case.complaints == []
        now_ns = SINCE_1970 + second * S
        assert case.sent(now_ns - 35 * S, now_ns).at(now_ns) is None
    (text,) = case.complaints
    assert text.startswith("what /talker sends is ignored: it is 35 s old")
    assert "lifespan is 10 s" in text
