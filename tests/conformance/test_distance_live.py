"""The tutorial's three terminals: node, playback, and the increasing distance."""

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
from fleet import Fleet

from free_ports import free_endpoint

pytestmark = pytest.mark.long

DRIVE = Path(__file__).parents[2] / "examples" / "data" / "drive.mcap"
DISTANCE = "/odom_integrator/distance"


def navette(env: Mapping[str, str], *words: str) -> str:
    """Return the output of a verb."""
    done = subprocess.run(
        [sys.executable, "-m", "navette", *words],
        env={**os.environ, "NAVETTE_TRANSPORT": "zenoh", **env},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_the_distance_increases_while_the_bag_plays(tmp_path: Path) -> None:
    env = {"NAVETTE_ROUTER": free_endpoint()}
    with Fleet(tmp_path, env) as fleet:
        fleet.start("integrator", "odom_integrator")
        once = ("topic", "echo", "--once", "--timeout", "30", DISTANCE)
        assert navette(env, *once) == "data: 0.0\n---\n"
        navette(env, "bag", "play", "-r", "30", str(DRIVE))
        (metres,) = re.findall(r"data: ([\d.]+)", navette(env, *once))
        # A queue of one: where this machine is busy, a bend is cut short. The exact
        # figure is that of test_distance.py.
        assert 90.0 < float(metres) < 102.5
    assert fleet.running["integrator"].returncode in (0, 130)
