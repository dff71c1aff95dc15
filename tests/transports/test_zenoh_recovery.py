"""What is lost between two sessions of Navette comes still, once and in order."""

import logging
from collections.abc import Iterable, Iterator
from typing import Any

import pytest
from transport_benches import ZenohPair, message_of, until

from navette.msgs import serialize
from navette.msgs.std_msgs.msg import String
from navette.transports import (
    Encoded,
    Endpoint,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    Item,
    ReliabilityPolicy,
    TransportObserver,
)
from navette.transports.zenoh import ZenohTransport
from navette.transports.zenoh import transport as transport_module
from navette.transports.zenoh.recovery import (
    absences,
    hub,
    offers,
    retention,
    starts,
    wants,
)
from navette.transports.zenoh.recovery.mail import Letter, ask_key, mail_key

DEPTH = 20
QOS = EndpointQos(depth=DEPTH)


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    monkeypatch.setattr(hub, "_TICK_S", 0.02)
    monkeypatch.setattr(starts, "_LETTER_TICKS", 1000)
    monkeypatch.setattr(starts, "_TOKEN_TICKS", 1000)
    pair = ZenohPair()
    yield pair
    pair.close()


class Speaker:
    """A publisher at the far end, on a network that drops what it is told to."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos = QOS) -> None:
        end = _endpoint(EndpointKind.PUBLISHER, qos)
        self.port: Any = pair.far_zenoh.advertise(end, String)
        self._put = self.port._put
        self.number = 0
        self.puts = 0

    def say(self, count: int, *, drop: Iterable[int] = ()) -> None:
        """Publish the next ``count`` numbers; those of ``drop`` do not arrive."""
        dropped = set(drop)
        for _ in range(count):
            self.number += 1
            self.port._put = self._drop if self.number in dropped else self._carry
            self.port.send(String(data=str(self.number)), 0, self.number)

    def _carry(self, data: Any, attachment: bytes) -> None:
        self.puts += 1
        self._put(data, attachment=attachment)

    def _drop(self, data: Any, attachment: bytes) -> None:
        self.puts += 1


class Ear(TransportObserver):
    """A subscription at the near end."""

    def __init__(self, pair: ZenohPair, qos: EndpointQos = QOS) -> None:
        self.items: list[Item] = []
        self.lost = 0
        pair.near.observe(self)
        self.endpoint = _endpoint(EndpointKind.SUBSCRIPTION, qos)
        self.port: Any = pair.near_zenoh.subscribe(
            self.endpoint, String, self.items.append, shared=False
        )

    def message_lost(self, subscription: Endpoint, count: int) -> None:
        if subscription is self.endpoint:
            self.lost += count

    @property
    def numbers(self) -> list[int]:
        return [int(message_of(item).data) for item in self.items]

    def await_loss(self, count: int) -> None:
        """It is told after what comes then has been delivered."""
        until(lambda: self.lost >= count, f"{count} lost")
        assert self.lost == count

    def await_(self, *numbers: int) -> None:
        until(lambda: len(self.items) >= len(numbers), f"samples {numbers}")
        assert self.numbers == list(numbers)


def _endpoint(kind: EndpointKind, qos: EndpointQos) -> Endpoint:
    return Endpoint(kind, "/t", "std_msgs/msg/String", qos, "n", "/", b"")


def acquaint(pair: ZenohPair, speaker: Speaker, *ears: Ear) -> None:
    """Wait until these know from where on they are owed something, and by whom."""
    pair.settle()
    gid = speaker.port._gid
    until(lambda: all(gid in e.port.arrivals._lanes for e in ears), "the first letter")


def part(transport: ZenohTransport) -> list[str]:
    """What the loss of a link is for one end: all tokens are gone."""
    graph = transport.session.graph
    keys = [*graph._nodes, *graph._endpoints]
    graph.on_tokens((key, False) for key in keys)
    return keys


def meet(transport: ZenohTransport, keys: list[str]) -> None:
    """The link is back."""
    transport.session.graph.on_tokens((key, True) for key in keys)


def mute(pair: ZenohPair, monkeypatch: pytest.MonkeyPatch) -> None:
    """The near end's asks get no answer, ever."""
    recovery = pair.near_zenoh._recovery
    assert recovery is not None
    monkeypatch.setattr(recovery.wants, "_get", lambda *_: None)


def test_what_is_lost_on_the_way_comes_still_and_in_order(pair: ZenohPair) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(10, drop=(2, 3, 7))
    ear.await_(*range(1, 11))
    assert ear.lost == 0


def test_the_first_after_the_match_comes_too(pair: ZenohPair) -> None:
    speaker = Speaker(pair)
    speaker.say(5)
    ear = Ear(pair)
    acquaint(pair, speaker, ear)
    speaker.say(2, drop=(6,))
    ear.await_(6, 7)
    assert ear.lost == 0


def test_the_last_ones_come_when_the_publisher_has_fallen_silent(
    pair: ZenohPair,
) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(3, drop=(1, 2, 3))
    ear.await_(1, 2, 3)
    assert ear.lost == 0


def test_what_is_beyond_the_depth_is_lost_and_counted(pair: ZenohPair) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(1)
    speaker.say(DEPTH + 5, drop=range(2, DEPTH + 6))
    ear.await_(1, *range(7, DEPTH + 7))
    ear.await_loss(5)


def test_long_samples_come_in_an_answer_of_their_own(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(retention, "_MOST_SHORT", 20)
    monkeypatch.setattr(retention, "_MOST_LONG", 30)
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(1)
    speaker.port.send(String(data="0" * 99 + "2"), 0, 2)
    speaker.number = 2
    speaker.port._put = speaker._drop
    speaker.port.send(String(data="0" * 99 + "3"), 0, 3)
    speaker.number = 3
    speaker.say(5, drop=(4, 5, 6, 8))
    ear.await_(*range(1, 9))
    assert ear.lost == 0


def test_a_late_joiner_hears_nothing_older(pair: ZenohPair) -> None:
    first, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, first)
    speaker.say(5, drop=(5,))
    pair.settle()
    second = Ear(pair)
    pair.settle()
    speaker.say(2)
    first.await_(*range(1, 8))
    second.await_(6, 7)
    assert (first.lost, second.lost) == (0, 0)


def test_the_latched_are_recovered_as_well(pair: ZenohPair) -> None:
    latched = EndpointQos.latched(DEPTH)
    speaker = Speaker(pair, latched)
    speaker.say(3)
    ear = Ear(pair, latched)
    ear.await_(1, 2, 3)
    pair.settle()
    speaker.say(4, drop=(5, 6))
    ear.await_(*range(1, 8))
    assert ear.lost == 0


def test_a_lost_link_loses_nothing_within_the_depth(pair: ZenohPair) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    speaker.say(3)
    ear.await_(1, 2, 3)
    pair.settle()
    near, far = part(pair.near_zenoh), part(pair.far_zenoh)
    assert speaker.port.matched_count == 0
    speaker.say(DEPTH, drop=range(1, 100))
    meet(pair.far_zenoh, far)
    meet(pair.near_zenoh, near)
    ear.await_(*range(1, DEPTH + 4))
    assert ear.lost == 0


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
            _endpoint(EndpointKind.SUBSCRIPTION, QOS), String, print, shared=False
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


def test_one_that_never_answers_is_given_up(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    far = pair.far_zenoh._recovery
    assert far is not None
    monkeypatch.setattr(far._desk, "_answer", lambda query, ask: query.drop())
    speaker.say(4, drop=(2, 3))
    ear.await_(1, 4)
    ear.await_loss(2)


class Letters:
    """What the far end writes: lost on the way while ``are_lost``."""

    def __init__(self, pair: ZenohPair, monkeypatch: pytest.MonkeyPatch) -> None:
        far = pair.far_zenoh._recovery
        assert far is not None
        self.are_lost = True
        self._post = far.post
        monkeypatch.setattr(far, "post", self._write)

    def _write(self, to: str, letter: Letter) -> None:
        if not self.are_lost:
            self._post(to, letter)


def test_what_is_lost_before_the_first_letter_comes_still(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where that letter is lost: it is asked for."""
    speaker, letters = Speaker(pair), Letters(pair, monkeypatch)
    speaker.say(5)
    ear = Ear(pair)
    pair.settle()
    speaker.say(5, drop=(6, 7, 9))
    pair.settle()
    assert ear.items == []
    letters.are_lost = False
    ear.await_(6, 7, 8, 9, 10)
    assert ear.lost == 0


def test_a_publisher_whose_letters_never_come_is_heard_all_the_same(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(starts, "_LETTER_TICKS", 3)
    speaker = Speaker(pair)
    Letters(pair, monkeypatch)
    speaker.say(5)
    ear = Ear(pair)
    pair.settle()
    speaker.say(4, drop=(6, 8))
    ear.await_(7, 8, 9)
    assert ear.lost == 0


def test_who_closes_before_its_first_letter_is_waited_for_no_longer(
    pair: ZenohPair, monkeypatch: pytest.MonkeyPatch
) -> None:
    speaker, letters = Speaker(pair), Letters(pair, monkeypatch)
    speaker.say(5)
    ear = Ear(pair)
    pair.settle()
    speaker.say(1)
    pair.settle()
    letters.are_lost = False
    far = pair.far_zenoh._recovery
    assert far is not None
    monkeypatch.setattr(far.offers, "on_where", lambda *_: None)
    speaker.port.close()
    ear.await_(6)


@pytest.fixture
def strange_pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    """The sessions do not know each other for Navette's, as none of ROS 2's is."""
    monkeypatch.setattr(transport_module, "new_zid", lambda: "")
    pair = ZenohPair()
    yield pair
    pair.close()


def test_one_that_is_not_of_navette_is_not_waited_for(strange_pair: ZenohPair) -> None:
    pair = strange_pair
    speaker = Speaker(pair)
    assert speaker.port.assert_alive()  # to nobody
    speaker.say(5)
    ear = Ear(pair)
    pair.settle()
    assert not speaker.port.assert_alive()
    assert not speaker.port._retention.keeps(5)
    speaker.say(5, drop=(6, 8))
    ear.await_(7, 9, 10)
    ear.await_loss(1)
    ear.port.close()
    pair.settle()
    speaker.say(1)
    assert speaker.puts == 5


def test_best_effort_is_as_it_was(pair: ZenohPair) -> None:
    loose = EndpointQos(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
    ear, speaker = Ear(pair, loose), Speaker(pair)
    strict = Ear(pair)
    acquaint(pair, speaker, strict)
    speaker.say(4, drop=(2, 3))
    strict.await_(1, 2, 3, 4)
    ear.await_(1, 4)
    ear.await_loss(2)
    assert strict.lost == 0


def test_two_subscriptions_recover_each_for_itself(pair: ZenohPair) -> None:
    keeps_all = EndpointQos(history=HistoryPolicy.KEEP_ALL)
    ears, speaker = [Ear(pair), Ear(pair, keeps_all)], Speaker(pair)
    acquaint(pair, speaker, *ears)
    speaker.say(6, drop=(1, 4, 6))
    for ear in ears:
        ear.await_(1, 2, 3, 4, 5, 6)
        assert ear.lost == 0


def test_letters_and_asks_of_any_shape_do_no_harm(
    pair: ZenohPair, caplog: pytest.LogCaptureFixture
) -> None:
    ear, speaker = Ear(pair), Speaker(pair)
    acquaint(pair, speaker, ear)
    near, far = pair.near_zenoh.session, pair.far_zenoh.session
    box = mail_key(7, near.zid, far.zid)
    hostile = [b"", b"\x09", b"\x01x", b"\x04x", bytes(100_000), b"\x01" + bytes(24)]
    hostile += [bytes([kind]) + bytes(16 * 2000) for kind in (3, 4, 6, 7, 8)]
    with caplog.at_level(logging.WARNING):
        for data in [*hostile, b"\x02" + speaker.port._gid + b"\xff" * 8, b"\x03"]:
            far.zenoh.put(box, data)
        far.zenoh.put(mail_key(7, near.zid, "no_session"), b"\x03")
        for data in [b"", bytes(40), bytes(41), b"\xff" * 50, b"\xff" * 40 + b"ab"]:
            list(near.zenoh.get(ask_key(7, far.zid), payload=data, timeout=5.0))
        speaker.say(3, drop=(2,))
        ear.await_(1, 2, 3)
    ignored = [r for r in caplog.records if "ignored" in r.getMessage()]
    assert len(ignored) == 2
    assert ear.lost == 0
