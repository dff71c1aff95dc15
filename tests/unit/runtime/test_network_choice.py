"""Choice of a context's transports."""

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
def test_the_default_depends_on_the_clock(
    clock: ContextClock, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT")
    monkeypatch.delenv("PYTEST_CURRENT_TEST")
    assert chosen_transport(None, clock) == expected


def test_tests_are_isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NAVETTE_TRANSPORT")
    assert chosen_transport(None, SystemClock()) == "inprocess"


def test_the_argument_takes_precedence_over_the_variable(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NAVETTE_TRANSPORT", "zenoh")
    assert chosen_transport(None, VirtualClock()) == "zenoh"
    assert chosen_transport("inprocess", SystemClock()) == "inprocess"


def test_the_error_of_an_unknown_name_lists_the_known_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(InvalidValueError, match=r"'udp'; known: inprocess, zenoh"):
        Context(transport="udp")
    monkeypatch.setenv("NAVETTE_TRANSPORT", "Zenoh")
    with pytest.raises(InvalidValueError, match=r"NAVETTE_TRANSPORT: .*'Zenoh'"):
        Context().init(args=[])
