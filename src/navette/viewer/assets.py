"""Files that clients may fetch: ``package://`` addresses of known folders only."""

from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

from navette.errors import UnknownNameError

_MAX_BYTES = 32_000_000


class AssetFolders:
    """Reads ``package://<name>/<path>`` below the folder known as ``name``.

    Nothing else is served: no other scheme, no path that leaves the folder (by
    ``..``, an absolute part or a symbolic link), nothing over 32 MB.
    """

    def __init__(self, folders: Mapping[str, Path]) -> None:
        self._folders = {name: folder.resolve() for name, folder in folders.items()}

    def read(self, uri: str) -> bytes:
        """The file's bytes.

        Raises:
            UnknownNameError: the address is not served or not there.
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
        path = folder.joinpath(*PurePosixPath(relative).parts).resolve()
        return path if path.is_relative_to(folder) else None
