"""Read-only and full folders for programs under test, also where they run as root."""

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

# Mount namespaces, because permissions do not restrict root.
_UNSHARE = ("unshare", "--map-root-user", "--mount")
_READ_ONLY = (
    'mount --bind "$1" "$1" && mount -o remount,ro,bind "$1" || exit 99\nshift\n'
)
_SMALL = 'mount -t tmpfs -o size="$2" tmpfs "$1" && shift 2 && '


def read_only(folders: Sequence[Path], command: Sequence[str]) -> list[str]:
    """Return a command that runs ``command`` with write-protected folders."""
    script = _READ_ONLY * len(folders) + 'exec "$@"'
    return [*_UNSHARE, "sh", "-c", script, "sh", *map(str, folders), *command]


def small(folder: Path, size: str, command: Sequence[str]) -> list[str]:
    """Return a command that runs ``command`` with a small file system in a folder."""
    return [
        *_UNSHARE,
        "sh",
        "-c",
        _SMALL + 'exec "$@"',
        "sh",
        str(folder),
        size,
        *command,
    ]


def _why_not() -> str:
    if shutil.which("unshare") is None:
        return "unshare"
    run = subprocess.run([*_UNSHARE, "true"], capture_output=True, text=True)
    return run.stderr.strip()


needs_mounts = pytest.mark.skipif(
    bool(_why_not()), reason=f"mount namespaces are not permitted here: {_why_not()}"
)
