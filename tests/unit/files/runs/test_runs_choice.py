"""The run that a program joins: named, the only one, or none."""

import json
import os

import pytest

from navette import __version__
from navette.errors import InvalidValueError, NetworkError
from navette.files.runs import (
    PrivateRun,
    chosen_run,
    every_network,
    pin_run,
    shares,
    stay_shared,
)


def test_the_only_run_is_joined_with_nothing_prepared(demo: PrivateRun) -> None:
    found = chosen_run({})
    assert found is not None
    assert found.name == "demo"


def test_without_runs_the_shared_network_is_joined() -> None:
    assert chosen_run({}) is None


@pytest.mark.parametrize(
    "variable",
    [
        "ROS_DOMAIN_ID",
        "NAVETTE_ROUTER",
        "NAVETTE_LISTEN",
        "NAVETTE_SECURITY",
        "NAVETTE_LOCKSTEP",
        "ZENOH_SESSION_CONFIG_URI",
        "ZENOH_ROUTER_CONFIG_URI",
        "ZENOH_CONFIG_OVERRIDE",
    ],
)
def test_a_program_that_names_a_network_shares_it(
    demo: PrivateRun, variable: str
) -> None:
    assert shares({variable: "0"})
    assert chosen_run({variable: "0"}) is None
    assert not shares({variable: ""})
    named = chosen_run({variable: "0", "NAVETTE_RUN": "demo"})
    assert named is not None  # the name is the more specific request


def test_shared_joins_no_run(demo: PrivateRun) -> None:
    assert chosen_run({"NAVETTE_RUN": "shared"}) is None


def test_named_only_joins_no_other_run(demo: PrivateRun) -> None:
    assert chosen_run({}, named_only=True) is None
    assert chosen_run({"NAVETTE_RUN": "demo"}, named_only=True) is not None


def test_of_several_runs_one_must_be_named(demo: PrivateRun) -> None:
    second = PrivateRun.claim("sim", world="course")
    second.publish("")
    with pytest.raises(NetworkError) as failed:
        chosen_run({})
    pid = os.getpid()
    assert str(failed.value).splitlines() == [
        "2 runs; choose one with --run NAME:",
        "",
        f"  demo  navette demo  arena   http://127.0.0.1:8765  pid {pid}",
        f"  sim   navette sim   course                         pid {pid}",
        "",
        "or for all programs of this terminal: export NAVETTE_RUN=demo",
        "to stop every robot: navette stop --all",
    ]
    assert every_network() == ["demo", "sim", "shared"]
    found = chosen_run({"NAVETTE_RUN": "sim"})
    assert found is not None
    assert found.name == "sim"
    second.close()


def test_a_name_that_no_run_has_lists_the_runs(demo: PrivateRun) -> None:
    with pytest.raises(NetworkError, match=r"no run 'hall' .*; runs: demo"):
        chosen_run({"NAVETTE_RUN": "hall"})
    demo.close()
    with pytest.raises(NetworkError, match="start one with navette demo"):
        chosen_run({"NAVETTE_RUN": "demo"})


def test_a_name_that_cannot_be_one_is_refused() -> None:
    with pytest.raises(InvalidValueError, match=r"'\.\./x': a name has at most"):
        chosen_run({"NAVETTE_RUN": "../x"})


def test_a_run_of_another_version_is_refused_with_both_versions(
    demo: PrivateRun,
) -> None:
    other = {"protocol": 9, "pid": 1, "navette": "7.0"}
    (demo.info.folder / "run.json").write_text(json.dumps(other))
    with pytest.raises(NetworkError) as failed:
        chosen_run({})
    text = str(failed.value)
    assert "started by Navette 7.0, whose run protocol is 9" in text
    assert f"Navette {__version__} with protocol 1" in text
    assert "NAVETTE_RUN=shared" in text


def test_a_robot_stays_out_of_the_only_run_with_a_note(
    demo: PrivateRun, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_RUN", "")
    stay_shared()
    assert os.environ["NAVETTE_RUN"] == "shared"
    assert "does not join run demo; to join: --run NAME" in caplog.text
    monkeypatch.setenv("NAVETTE_RUN", "demo")
    stay_shared()
    assert os.environ["NAVETTE_RUN"] == "demo"


def test_children_join_what_their_parent_joined(
    demo: PrivateRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_RUN", "")
    pin_run()
    assert os.environ["NAVETTE_RUN"] == "demo"
    demo.close()
    monkeypatch.setenv("NAVETTE_RUN", "")
    pin_run()
    assert os.environ["NAVETTE_RUN"] == "shared"
