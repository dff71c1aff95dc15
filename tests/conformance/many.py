"""Many processes that start together from one launch file, and discover each other."""

import os
import re
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

from free_ports import free_endpoint
from navette.runtime.clock import Stopwatch

PROGRAM = Path(__file__).parent / "programs" / "one_of_many.py"
DOMAIN = "93"
_REPORT = re.compile(r"(\d+) sees (all: )?(\d+) nodes (\d+) topics(?: ([\d.]+) s CPU)?")
_USAGE = re.compile(r"\d+ used ([\d.]+) s CPU")
_LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(executable={program!r}, arguments=[str(number), "{count}"])
        for number in range({count})
    ])
"""


@dataclass(frozen=True)
class Meeting:
    """Result of :func:`meet`.

    Attributes:
        complete: process number → seconds from the start until it has discovered all.
        last: process number → nodes and topics that it has discovered.
        output: all output.
        code: exit code of the launch.
        discovery_cpu_s: CPU time of all processes from joining the network to the end
            of discovery.
        cpu_s: CPU time of the launch and of all nodes including start and end, without
            the imports of the fork server; depends less than the wall time on other
            load. The caller must not wait for other children.
    """

    complete: dict[int, float]
    last: dict[int, tuple[int, int]]
    output: str
    code: int
    discovery_cpu_s: float
    cpu_s: float


def meet(count: int, folder: Path, patience_s: float) -> Meeting:
    """Launch ``count`` processes of four topics each until all have discovered all."""
    file = folder / "many.launch.py"
    file.write_text(_LAUNCH.format(program=str(PROGRAM), count=count))
    watch, before = Stopwatch(), os.times()
    process = subprocess.Popen(
        [sys.executable, "-m", "navette", "launch", "--processes", str(file)],
        env={
            **os.environ,
            "NAVETTE_ROUTER": free_endpoint(),
            "NAVETTE_TRANSPORT": "zenoh",
            "ROS_DOMAIN_ID": DOMAIN,
            "ROS_LOG_DIR": str(folder / "log"),
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    limit = threading.Timer(patience_s, process.send_signal, [signal.SIGINT])
    limit.start()
    complete: dict[int, float] = {}
    last: dict[int, tuple[int, int]] = {}
    lines = []
    discovery_cpu_s = 0.0
    with process:
        assert process.stdout is not None
        for line in process.stdout:
            lines.append(line)
            found = _REPORT.search(line)
            if found is None:
                continue
            number = int(found[1])
            last[number] = int(found[3]), int(found[4])
            if found[2] and number not in complete:
                complete[number] = watch.elapsed_s
                discovery_cpu_s += float(found[5])
                if len(complete) == count:
                    limit.cancel()
                    process.send_signal(signal.SIGINT)
    limit.cancel()
    after = os.times()
    output = "".join(lines)
    # The nodes are children of the fork server, not of the launch.
    nodes_cpu_s = sum(map(float, _USAGE.findall(output)))
    cpu_s = sum(after[2:4]) - sum(before[2:4]) + nodes_cpu_s
    return Meeting(complete, last, output, process.returncode, discovery_cpu_s, cpu_s)
