"""World and robot files that would exhaust memory or time are refused at once."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fuzz import models
from fuzz.limits import within
from navette.errors import FileFormatError
from navette.sim import load_robot, load_world
from navette.sim.limits import MOST_MOVING

pytestmark = pytest.mark.long


@pytest.mark.parametrize("write", models.WORLDS, ids=lambda each: each.__name__)
def test_worlds(write: Callable[[Path], Path], tmp_path: Path) -> None:
    path = write(tmp_path)
    with within(), pytest.raises(FileFormatError, match=r"at most|more than|exceeds"):
        load_world(path)


@pytest.mark.parametrize("write", models.ROBOTS, ids=lambda each: each.__name__)
def test_robots(write: Callable[[Path], Path], tmp_path: Path) -> None:
    path = write(tmp_path)
    with within(), pytest.raises(FileFormatError, match=r"at most|more than|expected"):
        load_robot(path)


def test_a_robot_at_the_limit_is_read(tmp_path: Path) -> None:
    links = MOST_MOVING - 3  # base and two wheels
    path = models.urdf_robot_with_many_bodies(tmp_path, links)
    assert len(load_robot(path).model.links) > 2
