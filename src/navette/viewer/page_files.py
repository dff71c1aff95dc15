"""The built files of the page: what `npm run build` in ``web/`` writes."""

import gzip
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.resources.abc import Traversable
from pathlib import PurePosixPath

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".webmanifest": "application/manifest+json",
    ".json": "application/json",
    ".png": "image/png",
    ".txt": "text/plain; charset=utf-8",
}


@dataclass(frozen=True)
class PageFile:
    content_type: str
    body: bytes

    @cached_property
    def compressed(self) -> bytes:
        """The body as gzip, packed at the first request: not while a robot starts."""
        return gzip.compress(self.body, 6, mtime=0)


def read_page(folder: Traversable) -> Mapping[str, PageFile]:
    """Return the files below a folder by path; ``index.html`` also as ``/``."""
    files = {}
    for path, file in _walk(folder, "/"):
        kind = _TYPES.get(PurePosixPath(path).suffix)
        if kind is not None:
            files[path] = PageFile(kind, file.read_bytes())
    if "/index.html" in files:
        files["/"] = files["/index.html"]
    return files


def _walk(folder: Traversable, prefix: str) -> Iterator[tuple[str, Traversable]]:
    if not folder.is_dir():
        return
    for entry in folder.iterdir():
        path = f"{prefix}{entry.name}"
        if entry.is_dir():
            yield from _walk(entry, f"{path}/")
        else:
            yield path, entry
