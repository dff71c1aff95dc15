"""Nav2's servers and clients of the stack with the definitions of each distribution."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from navette.msgs.registry import DISTRO_VARIABLE, DISTROS

PROGRAM = Path(__file__).parent / "programs" / "nav2_servers.py"
LIMIT_S = 110.0

pytestmark = pytest.mark.long

# What each call ends with; the reason is in the result since Jazzy.
ENDS = """
compute_path_to_pose: succeeded
compute_path_through_poses: succeeded
smooth_path: succeeded
smooth_path: ended 6 (smoother_id 'none': unknown; known: simple_smoother)
follow_path: succeeded
follow_path: ended 6 (controller_id 'none': unknown; known: FollowPath
spin: succeeded
backup: succeeded
drive_on_heading: succeeded
drive_on_heading: ended 6 (an obstacle within 2 s of motion)
wait: succeeded
assisted_teleop: ended 6 (not complete within 1 s)
navigate_to_pose: succeeded
navigate_to_pose: ended 6 (/no/tree.xml: cannot be opened
navigate_through_poses: succeeded
follow_waypoints: succeeded (goal (90, 90): no_path)
""".strip().splitlines()


@pytest.mark.parametrize("distro", DISTROS)
def test_servers_and_commander_speak_the_chosen_distribution(distro: str) -> None:
    run = subprocess.run(
        [sys.executable, str(PROGRAM)],
        env={**os.environ, DISTRO_VARIABLE: distro},
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    assert run.returncode == 0, run.stderr[-3000:]
    lines = run.stdout.splitlines()
    found = [line for line in lines if not line.startswith("[")]
    for line, expected in zip(found, ENDS, strict=False):
        text = expected.partition(" (")[0] if distro == "humble" else expected
        assert line.startswith(text)
    rest = found[len(ENDS) :]
    done = "True" if distro in ("lyrical", "rolling") else "done"
    cleared = [line for line in rest if "clear_" in line]
    assert len(cleared) == 6
    assert all(line.endswith(f": {done}") for line in cleared)
    assert rest[-5:] == [
        "is_path_valid: True",
        "commander, path: True",
        "commander, through: SUCCEEDED",
        "commander, waypoints: SUCCEEDED",
        "commander, follow: SUCCEEDED",
    ]
