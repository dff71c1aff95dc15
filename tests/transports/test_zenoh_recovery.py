"""What is lost between two sessions of Navette comes still, once and in order."""

import logging
from collections.abc import Iterator

import pytest
from recovery_benches import (
    DEPTH,
    Ear,
    Speaker,
    acquaint,
    hurried_pair,
    meet,
    part,
)
from transport_benches import ZenohPair

from navette.msgs.std_msgs.msg import String
from navette.transports import (
    EndpointQos,
    HistoryPolicy,
    ReliabilityPolicy,
)
from navette.transports.zenoh.recovery import retention
from navette.transports.zenoh.recovery.mail import ask_key, mail_key


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    with hurried_pair(monkeypatch) as pair:
        yield pair


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
