"""Replace existing recordings, but no other files."""

import shutil
from pathlib import Path

from navette.bags.opening import holds_bag, is_bag
from navette.bags.recording_file import busy, exists_already, is_being_recorded
from navette.errors import FileFormatError


def make_way(path: Path, *, overwrite: bool) -> None:
    """Refuse an existing path, or remove an existing folder of a recording.

    An existing file stays until its replacement is complete.

    Raises:
        FileFormatError: the path exists and is not to be replaced, is not a recording,
            or is being recorded.
    """
    if not path.exists():
        return
    if is_being_recorded(path):
        raise busy(path)
    if not overwrite:
        raise exists_already(path)
    if not is_bag(path) or (path.is_file() and not holds_bag(path)):
        raise FileFormatError(path, "exists, is not a bag and is not replaced")
    if path.is_dir():
        shutil.rmtree(path)
