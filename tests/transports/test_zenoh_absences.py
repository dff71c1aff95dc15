"""Who is owed something while it is not seen, and who is not."""

from collections.abc import Iterator

import pytest
from recovery_benches import (
    QOS,
    Ear,
    Speaker,
    acquaint,
    hurried_pair,
    meet,
    mute,
    part,
    topic_end,
)
from transport_benches import ZenohPair, until

from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String
from navette.transports import Encoded, EndpointKind
from navette.transports.zenoh import ZenohTransport
from navette.transports.zenoh.recovery import absences, hub, offers, wants


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    with hurried_pair(monkeypatch) as pair:
        yield pair


def test_one_that_does_not_come_back_is_not_waited_for_any_longer(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(offers, "GRACE_TICKS", 2)
    monkeypatch.setattr(wants, "_GRACE_TICKS", 2)
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(1)
    ear.await_(1)
    pair.settle()
    part(pair.far_zenoh)

    def is_unheard() -> bool:
        before = speaker.puts
        speaker.say(1)
        return speaker.puts == before

    until(is_unheard, "the end of the grace time")


def test_who_has_died_is_owed_nothing(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Seen at once where the process is gone by then, else with the next tick."""
    dead: set[str] = set()
    monkeypatch.setattr(absences, "has_died", dead.__contains__)
    _, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker)
    keys = part(pair.far_zenoh)
    speaker.say(1)
    assert speaker.puts == 1
    dead.add(pair.near_zenoh.session.zid)

    def is_unheard() -> bool:
        before = speaker.puts
        speaker.say(1)
        return speaker.puts == before

    until(is_unheard, "a look at the process")
    meet(pair.far_zenoh, keys)
    part(pair.far_zenoh)
    assert is_unheard()


def test_those_beside_one_that_has_died_know_it(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On another machine nothing is known of it; a session there is asked."""
    _, speaker = Ear(pair), Speaker(pair)
    third = ZenohTransport(7, lambda: 7, pair.near_zenoh.session.settings)
    try:
        zid = third.session.zid
        keep = third.subscribe(
            topic_end(EndpointKind.SUBSCRIPTION, QOS), String, print, shared=False
        )
        until(lambda: speaker.port.matched_count == 2, "both listeners")
        acquaint(pair, speaker)
        monkeypatch.setattr(absences, "has_died", lambda _: False)
        graph = pair.far_zenoh.session.graph
        graph.on_tokens(
            (key, False) for key in [*graph._nodes, *graph._endpoints] if zid in key
        )
        far = pair.far_zenoh._recovery
        assert far is not None
        assert far.offers.awaited() == {zid}
        monkeypatch.setattr(hub, "has_died", zid.__eq__)
        until(lambda: not far.offers.awaited(), "the answer of the one beside it")
        assert keep.matched_count == 1
    finally:
        third.close()


def test_who_leaves_on_purpose_is_owed_nothing(pair: ZenohPair) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(2)
    ear.await_(1, 2)
    pair.settle()
    ear.port.close()
    pair.settle()
    speaker.say(2)
    assert speaker.puts == 2
    Ear(pair)
    pair.settle()
    speaker.say(1)
    pair.near.close()
    until(lambda: not pair.far.endpoints(), "the end of the other session")
    pair.far_zenoh.session.graph.counts()  # what was told by then has had its effect
    speaker.say(1)
    assert speaker.puts == 3


def test_a_publisher_that_closes_is_not_waited_for(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    mute(pair, monkeypatch)
    speaker.say(4, drop=(2, 3))
    ear.await_(1)
    speaker.port.close()
    ear.await_(1, 4)
    ear.await_loss(2)


def test_what_is_missed_of_one_that_has_left_by_then_is_not_waited_for(
    pair: ZenohPair,
) -> None:
    """Its last word came before its last sample, by another way."""
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(3, drop=(2, 3))
    ear.await_(1)
    pair.far.close()
    until(lambda: not pair.near.endpoints(), "its leaving")
    pair.near_zenoh.session.graph.counts()
    data = serialize(String(data="3"))
    item = Encoded(data, String, print), 0, 0, 3
    ear.port.arrivals.take(speaker.port._gid, item)
    ear.await_(1, 3)
    ear.await_loss(1)
