"""A program for nav2_simple_commander drives the simulated robot of another process."""

import os
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from program_run import NAVETTE

from navette.files.runs import VARIABLE
from navette.files.runs.choice import NETWORK_VARIABLES

PROGRAM = Path(__file__).parent / "programs" / "patrol.py"
EXPECTED = """\
path True
smoothed True
pose SUCCEEDED
spin SUCCEEDED
cancelled CANCELED
waypoints SUCCEEDED
costmap True
end
"""


@pytest.fixture
def environment() -> Iterator[dict[str, str]]:
    """Environment of a user with nothing set but the folder of the runs."""
    names = (
        *NETWORK_VARIABLES,
        VARIABLE,
        "NAVETTE_TRANSPORT",
        "PYTEST_CURRENT_TEST",
    )
    # A short path: those of Unix sockets have at most 107 bytes.
    with TemporaryDirectory() as folder:
        variables = {k: v for k, v in os.environ.items() if k not in names}
        yield {**variables, "NAVETTE_RUNTIME_DIR": folder}


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="private runs need POSIX")
def test_a_commander_program_drives_over_the_network(
    environment: dict[str, str],
) -> None:
    command = ["sim", "arena", "--port", "0", "--speed", "4"]
    with subprocess.Popen(
        [*NAVETTE, "--run", "patrolled", *command],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    ) as robot:
        try:
            assert robot.stderr is not None
            for line in robot.stderr:
                if "live view" in line:
                    break
            else:
                pytest.fail("the simulator did not start")
            done = subprocess.run(
                [*NAVETTE, "--run", "patrolled", "run", str(PROGRAM)],
                capture_output=True,
                text=True,
                timeout=120.0,
                check=False,
                env=environment,
            )
        finally:
            robot.send_signal(signal.SIGINT)
    assert done.stdout == EXPECTED, done.stderr
    assert done.returncode == 0
