"""Ids of Navette's sessions."""

import pytest

from navette.transports.zenoh.session_id import is_navette_session, new_session_id


def test_sessions_of_navette_are_recognised() -> None:
    one, other = new_session_id(), new_session_id()
    assert one != other
    assert len(bytes.fromhex(one)) == 16
    assert is_navette_session(one)


def test_the_id_is_small_so_that_ros_nodes_open_the_link() -> None:
    assert new_session_id().endswith("00")


@pytest.mark.parametrize("other", ["", "6e617665", "1" * 32])
def test_other_sessions_are_not_taken_for_navettes(other: str) -> None:
    assert not is_navette_session(other)
