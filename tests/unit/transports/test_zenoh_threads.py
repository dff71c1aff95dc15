"""Enough threads that lost links do not block the others."""

import os

import pytest

from navette.transports.zenoh import Settings
from navette.transports.zenoh.threads import provide_threads


@pytest.mark.parametrize(
    ("settings", "count"),
    [(Settings(), 8), (Settings(router=("tcp/10.0.0.1:7447",)), 64)],
    ids=["one machine", "several"],
)
def test_more_threads_between_machines_than_on_one(
    settings: Settings, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ZENOH_RUNTIME", raising=False)
    provide_threads(settings)
    text = os.environ["ZENOH_RUNTIME"]
    assert text.startswith(f"(rx:(worker_threads:{count}),net:(worker_threads:")
    assert text.endswith("))")


def test_a_child_process_sets_its_own_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ZENOH_RUNTIME", raising=False)
    provide_threads(Settings())
    inherited = os.environ["ZENOH_RUNTIME"]
    provide_threads(Settings(router=("tcp/10.0.0.1:7447",)))
    assert os.environ["ZENOH_RUNTIME"] != inherited
    provide_threads(Settings())
    assert os.environ["ZENOH_RUNTIME"] == inherited


def test_a_value_in_the_environment_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZENOH_RUNTIME", "(rx:(worker_threads:4))")
    provide_threads(Settings())
    assert os.environ["ZENOH_RUNTIME"] == "(rx:(worker_threads:4))"
