"""Compile the kernels of a drive for a generic processor: the archive of a wheel.

    python -m navette.navigation.stack.kernel_build

writes the archive of this Python and platform into the package (hatch_build.py runs it
when a wheel is built).
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from navette.files.kernel_archive import (
    archive_path,
    generic_processor,
    write_archive,
)
from navette.files.kernels import read_kernel
from navette.navigation.stack.kernel_part import PARTS

_MOST_S = 900.0  # a minute on an idle machine
_PART_MODULE = "navette.navigation.stack.kernel_part"


def build_archive() -> int:
    """Write the package's archive, each part compiled in a process of its own.

    Returns:
        The number of kernels.

    Raises:
        OSError: this host does not run the machine code of its generic processor.
        subprocess.SubprocessError: the kernels did not compile, or took too long.
    """
    if generic_processor() is None:
        raise OSError("this processor is older than the generic one of its kind")
    path = archive_path()
    path.unlink(missing_ok=True)  # kernels that are loaded from it are not stored
    with tempfile.TemporaryDirectory() as cache:
        environment = {
            **os.environ,
            "NUMBA_CACHE_DIR": cache,
            "NUMBA_DISABLE_INTEL_SVML": "1",  # not every host has it
        }
        commands = [[sys.executable, "-m", _PART_MODULE, part] for part in PARTS]
        processes = [subprocess.Popen(each, env=environment) for each in commands]
        try:
            for process in processes:
                process.wait(_MOST_S)
        finally:
            for process in processes:
                process.kill()  # without effect if it has ended
                process.wait()
        for command, process in zip(commands, processes, strict=True):
            if process.returncode != 0:
                raise subprocess.CalledProcessError(process.returncode, command)
        files = Path(cache).rglob("*.kernel")
        kernels = {each.name: code for each in files if (code := read_kernel(each))}
    write_archive(path, kernels)
    return len(kernels)


def main() -> None:
    """Write the archive, and print its size."""
    count = build_archive()
    path = archive_path()
    size_mb = path.stat().st_size / 1e6
    sys.stdout.write(f"{path}: {count} kernels, {size_mb:.1f} MB\n")


if __name__ == "__main__":
    main()
