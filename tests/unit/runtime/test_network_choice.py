"""Which transports a context has."""

import pytest

from navette.errors import InvalidValueError
from navette.runtime import Context, PacedClock, SystemClock, VirtualClock
from navette.runtime.clock import ContextClock
from navette.runtime.network import chosen_transport


@pytest.mark.parametrize(
    ("clock", "expected"),
    [
        (SystemClock(), "zenoh"),
        (PacedClock(), "zenoh"),
        (VirtualClock(), "inprocess"),
    ],
)
def test_by_the_clock_where_nothing_is_said(
    clock: ContextClock, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT")
    monkeypatch.delenv("PYTEST_CURRENT_TEST")
    assert chosen_transport(None, clock) == expected


def test_a_test_keeps_to_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT")
    assert chosen_transport(None, SystemClock()) == "inprocess"


def test_the_argument_wins_over_the_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NAVETTE_TRANSPORT", "zenoh")
    assert chosen_transport(None, VirtualClock()) == "zenoh"
    assert chosen_transport("inprocess", SystemClock()) == "inprocess"


def test_an_unknown_name_is_an_error_that_lists_the_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(InvalidValueError, match=r"'udp'; known: inprocess, zenoh"):
        Context(transport="udp")
    monkeypatch.setenv("NAVETTE_TRANSPORT", "Zenoh")
    with pytest.raises(InvalidValueError, match=r"NAVETTE_TRANSPORT: .*'Zenoh'"):
        Context().init(args=[])
