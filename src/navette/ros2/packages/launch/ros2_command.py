"""The command ``ros2`` for launch files that call it: ``navette`` has its verbs."""

import hashlib
import os
import shlex
import shutil
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from navette.files.folders import cache_folder


def with_ros2(env: Mapping[str, str] | None) -> Mapping[str, str] | None:
    """Add the command ``ros2`` to an environment without it.

    Launch files call it (``ros2 service call …``); ``navette`` has its verbs.
    """
    path = (os.environ if env is None else env).get("PATH", os.defpath)
    if shutil.which("ros2", path=path) is not None:
        return env
    folder = ros2_folder()
    if folder is None:
        return env
    base = os.environ if env is None else env
    return {**base, "PATH": f"{path}{os.pathsep}{folder}"}


def ros2_folder() -> Path | None:
    """Return a folder with ``ros2``; None if the cache cannot be written."""
    interpreter = hashlib.sha256(sys.executable.encode()).hexdigest()[:16]
    folder = cache_folder(f"commands-{interpreter}")
    if folder is None:
        return None
    text = f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m navette "$@"\n'
    command = folder / "ros2"
    if not command.is_file() or command.read_text(encoding="utf-8") != text:
        # Renamed into place, so that other processes never run a part of it.
        handle, name = tempfile.mkstemp(dir=folder)
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        Path(name).chmod(0o755)
        Path(name).replace(command)
    return folder
