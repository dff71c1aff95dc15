"""Definitions of a type in all distributions of ROS 2."""

import os
import subprocess
import sys

from navette.msgs.registry import DISTRO_VARIABLE, DISTROS

_PROGRAM = "import sys, navette.msgs as m; print(m.type_hash(sys.argv[1]))"


def distros_by_hash(type_name: str) -> dict[str, list[str]]:
    """Return the hashes of a type, each with the distributions that have it.

    A process each: the distribution of a process is fixed.
    """
    found: dict[str, list[str]] = {}
    for distro in DISTROS:
        result = subprocess.run(
            [sys.executable, "-c", _PROGRAM, type_name],
            env={**os.environ, DISTRO_VARIABLE: distro},
            capture_output=True,
            text=True,
            check=False,
            timeout=30,
        )
        if result.returncode == 0:  # otherwise the type does not exist there
            found.setdefault(result.stdout.strip(), []).append(distro)
    return found
