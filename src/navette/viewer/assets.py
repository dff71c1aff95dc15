"""Files that clients may fetch: ``package://`` URIs of known folders only."""

from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

from navette.errors import UnknownNameError

_MAX_BYTES = 32_000_000


class AssetFolders:
    """Reads ``package://<name>/<path>`` below the folder registered as ``name``.

    Refuses other schemes, paths that leave the folder (by ``..``, an absolute part or a
    symbolic link) and files over 32 MB.
    """

    def __init__(self, folders: Mapping[str, Path]) -> None:
        self._folders = {name: folder.resolve() for name, folder in folders.items()}

    def read(self, uri: str) -> bytes:
        """Return the file's bytes.

        Raises:
            UnknownNameError: the URI is not served or the file does not exist.
            OSError: the file cannot be read.
        """
        path = self._path(uri)
        if path is None or not path.is_file() or path.stat().st_size > _MAX_BYTES:
            known = [f"package://{name}/…" for name in self._folders]
            raise UnknownNameError.of("asset", uri[:200], known)
        return path.read_bytes()

    def _path(self, uri: str) -> Path | None:
        try:
            parts = urlsplit(uri)
        except ValueError:
            return None
        folder = self._folders.get(parts.netloc)
        if parts.scheme != "package" or folder is None:
            return None
        relative = unquote(parts.path).lstrip("/")
        if "\0" in relative or "\\" in relative or ":" in relative:
            return None
        try:
            path = folder.joinpath(*PurePosixPath(relative).parts).resolve()
        except (OSError, UnicodeEncodeError):  # a loop of links, half a surrogate pair
            return None
        return path if path.is_relative_to(folder) else None
