"""Ids by which Navette's sessions know each other, and which of them have died."""

import os
import subprocess
import sys

import pytest

from navette.transports.zenoh import kin


def of_process(pid: int) -> str:
    """An id of a session on this machine."""
    own = kin.new_zid()
    return f"{own[:16]}{pid:08x}{own[24:]}"


def test_navettes_sessions_know_each_other() -> None:
    one, other = kin.new_zid(), kin.new_zid()
    assert one != other
    assert kin.is_kin(one)
    assert one.endswith("00")  # so that ROS 2's nodes call it
    assert kin.runs_beside(one, other)
    assert not kin.runs_beside(one, one)
    assert not kin.runs_beside(one, one[:8] + "0" * 8 + one[16:])
    for strange in ("", "6e617665", "1" * 32, one[:-1]):
        assert not kin.is_kin(strange)
        assert not kin.has_died(strange)
        assert not kin.runs_beside(one, strange)


def test_who_lives_has_not_died() -> None:
    assert not kin.has_died(kin.new_zid())
    assert not kin.has_died(of_process(1))  # another user's, perhaps
    assert not kin.has_died(of_process(2**32 - 1)[:8] + "0" * 24)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells where it runs")
def test_a_process_that_has_ended_has_died_also_before_it_is_waited_for() -> None:
    process = subprocess.Popen(["true"])
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    assert kin.has_died(of_process(process.pid))
    process.wait()
    assert kin.has_died(of_process(process.pid))


def test_where_the_system_tells_nothing_nobody_is_known_to_have_died(
    monkeypatch: pytest.MonkeyPatch, tmp_path: object
) -> None:
    monkeypatch.setattr(kin, "_BOOT", kin.Path(f"{tmp_path}/none"))
    kin._host.cache_clear()
    try:
        assert not kin.has_died("6e617665" + "1" * 8 + "7fffffff" + "0" * 8)
    finally:
        kin._host.cache_clear()


def test_a_process_id_that_cannot_be_is_nobodys() -> None:
    assert not kin.has_died("6e617665" + kin.new_zid()[8:16] + "f" * 8 + "0" * 8)
