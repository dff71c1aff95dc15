"""Whose publisher it is that a subscription hears: tokens say more than letters."""

from typing import Any

import pytest

from navette.transports import Endpoint, EndpointKind, EndpointQos
from navette.transports.zenoh.kin import new_zid
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery import hearing as hearing_module
from navette.transports.zenoh.recovery.hearing import Hearing
from navette.transports.zenoh.recovery.mail import Head

OWN, GID = b"o" * 16, b"p" * 16


def endpoint(kind: EndpointKind, gid: bytes) -> Endpoint:
    return Endpoint(kind, "/t", "std_msgs/msg/String", EndpointQos(), "n", "/", gid)


class Ear:
    """A subscription that notes what it is told."""

    def __init__(self) -> None:
        subscription = endpoint(EndpointKind.SUBSCRIPTION, OWN)
        self.matches = Matches(subscription, "hash", {}, lambda *_: None)
        self.key = "t"
        self.told: list[tuple[str, int]] = []

    def meets(self, zid: str) -> Endpoint:
        publisher = endpoint(EndpointKind.PUBLISHER, GID)
        self.matches.add(f"@ros2_lv/7/{zid}/1/2/MP/x", publisher)
        return publisher

    def start_after(self, gid: bytes, number: int) -> None:
        self.told.append(("start after", number))

    def start(self, gid: bytes) -> None:
        self.told.append(("start", 0))

    def reach(self, gid: bytes, number: int) -> None:
        self.told.append(("reach", number))

    def is_held_up(self, gid: bytes) -> bool:
        raise NotImplementedError

    def missing(self, gid: bytes) -> tuple[int, int] | None:
        raise NotImplementedError

    def recover(self, gid: bytes, sample: Any) -> None:
        raise NotImplementedError

    def give_up(self, gid: bytes, number: int | None) -> None:
        raise NotImplementedError


@pytest.fixture
def ear() -> Ear:
    return Ear()


@pytest.fixture
def hearing(ear: Ear) -> Hearing:
    hearing = Hearing()
    hearing.add(OWN, ear)
    return hearing


def test_the_first_letter_may_come_before_the_token(hearing: Hearing, ear: Ear) -> None:
    zid = new_zid()
    assert hearing.on_matched(zid, (Head(GID, 9), Head(OWN, 5), Head(GID, 1))) == GID
    assert ear.told == [("start after", 5), ("reach", 9)]
    hearing.on_match(ear.meets(zid), ear.matches.endpoint, up=True)
    assert (hearing.home(GID), hearing.hears(ear, GID)) == (zid, True)
    assert hearing.sessions() == {zid}
    hearing.on_head(zid, Head(GID, 12))
    assert ear.told[2:] == [("reach", 12)]


def test_a_letter_of_another_session_than_the_tokens_is_not_believed(
    hearing: Hearing, ear: Ear
) -> None:
    zid, stranger = new_zid(), new_zid()
    hearing.on_matched(stranger, (Head(GID, 0), Head(OWN, 0)))
    hearing.on_match(ear.meets(zid), ear.matches.endpoint, up=True)
    assert hearing.home(GID) == zid
    ear.told.clear()
    assert hearing.on_matched(stranger, (Head(GID, 0), Head(OWN, 0))) == b""
    hearing.on_head(stranger, Head(GID, 1))
    assert ear.told == []


def test_one_that_writes_no_letters_has_no_home_whoever_claims_it(
    hearing: Hearing, ear: Ear
) -> None:
    hearing.on_matched(new_zid(), (Head(GID, 0), Head(OWN, 0)))
    ear.told.clear()
    hearing.on_match(ear.meets("1234"), ear.matches.endpoint, up=True)
    assert (hearing.home(GID), ear.told) == (None, [("start", 0)])
    assert hearing.on_matched(new_zid(), (Head(GID, 0), Head(OWN, 0))) == b""
    assert hearing.on_matched("1234", (Head(GID, 0), Head(OWN, 0))) == b""


def test_who_makes_up_publishers_pushes_out_none_that_is_seen(
    hearing: Hearing, ear: Ear, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hearing_module, "_MOST_HOMES", 3)
    zid = new_zid()
    hearing.on_match(ear.meets(zid), ear.matches.endpoint, up=True)
    for number in range(10):
        made_up = number.to_bytes(16, "big")
        hearing.on_matched(zid, (Head(made_up, 0), Head(OWN, 0)))
    assert hearing.home(GID) == zid


def test_a_subscription_that_closes_is_forgotten(hearing: Hearing, ear: Ear) -> None:
    zid = new_zid()
    hearing.on_match(ear.meets(zid), ear.matches.endpoint, up=True)
    assert hearing.remove(ear.matches.endpoint) == (OWN, ear, {zid})
    assert hearing.remove(ear.matches.endpoint) == (b"", None, set())
    assert (hearing.knows(ear), hearing.hears(ear, GID)) == (False, False)
    assert hearing.on_matched(zid, (Head(GID, 0), Head(OWN, 0))) == GID
    assert ear.told == []
