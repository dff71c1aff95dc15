"""From which sample on a subscription is owed something."""

from collections.abc import Iterator

import pytest
from recovery_benches import Ear, Speaker, hurried_pair
from transport_benches import ZenohPair

from navette.transports.zenoh import transport as transport_module
from navette.transports.zenoh.recovery import starts
from navette.transports.zenoh.recovery.mail import Letter


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> Iterator[ZenohPair]:
    with hurried_pair(monkeypatch) as pair:
        yield pair


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
