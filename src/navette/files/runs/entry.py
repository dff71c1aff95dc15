"""Entry of a run in the registry: what other programs of the user need to join it."""

import json
import re
import secrets
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from navette import __version__
from navette.errors import FileFormatError, InvalidValueError

PROTOCOL = 1
"""Number of the agreement about sockets and wire format within a run."""

MAX_BYTES = 16_384
MAX_TEXT = 200
_MAX_DOMAIN = 232
_NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,23}")
_PAGE = re.compile(r"https?://[0-9A-Za-z.:\[\]-]{1,60}")


def is_run_name(text: str) -> bool:
    """Whether a text may name a run: it is part of socket paths."""
    return _NAME.fullmatch(text) is not None


def check_run_name(text: str) -> str:
    """Return the name.

    Raises:
        InvalidValueError: it may not name a run.
    """
    if not is_run_name(text):
        raise InvalidValueError(
            f"run {text!r}: a name has at most 24 characters, lower-case letters, "
            "digits, - and _, and does not begin with - or _"
        )
    return text


@dataclass(frozen=True, kw_only=True)
class RunInfo:
    """A run that programs of this user can join.

    Attributes:
        folder: contains its lock, its entry and the sockets of its programs.
        name: unique among the user's runs.
        command: what started it, such as ``navette demo``.
        world: name of the world.
        pid: process that started it.
        domain: its domain, as ``ROS_DOMAIN_ID``.
        page: address of the live view; empty without one.
        start_ns: time of its publication, in nanoseconds since 1970.
        navette: version of Navette that started it.
        protocol: :data:`PROTOCOL` of that version.
    """

    folder: Path
    name: str
    command: str
    world: str
    pid: int
    domain: int = 0
    page: str = ""
    start_ns: int = 0
    navette: str = field(default=__version__)
    protocol: int = PROTOCOL

    @property
    def router(self) -> str:
        """Zenoh endpoint at which the programs of the run discover each other."""
        return f"unixsock-stream/{self.folder / 'router.sock'}"

    def new_endpoint(self) -> str:
        """Return a Zenoh endpoint for one program of the run."""
        name = f"{secrets.token_hex(4)}.sock"
        return f"unixsock-stream/{self.folder / name}"

    @property
    def is_compatible(self) -> bool:
        return self.protocol == PROTOCOL

    def row(self) -> tuple[str, str, str, str, str]:
        """Return name, command, world, page and process id for a list of runs."""
        command = self.command or f"started by Navette {self.navette}"
        return self.name, command, self.world, self.page, str(self.pid)

    def to_json(self) -> str:
        record = asdict(self)
        del record["folder"], record["start_ns"]
        return json.dumps(record)

    @classmethod
    def from_json(cls, text: str, folder: Path, start_ns: int = 0) -> "RunInfo":
        """Read an entry; the name and the endpoints follow from the folder.

        Of an entry of another protocol only ``pid``, ``navette`` and ``protocol`` are
        read.

        Raises:
            FileFormatError: the text is not an entry.
        """
        try:
            record = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise FileFormatError(folder, f"not an entry of a run: {error}") from None
        if not isinstance(record, dict):
            raise FileFormatError(folder, "not an entry of a run: no JSON object")
        values = _Values(record, folder)
        protocol = values.number("protocol", 10**6)
        if protocol != PROTOCOL:
            record = {key: record.get(key) for key in ("pid", "navette")}
            values = _Values({"command": "", "world": "", **record}, folder)
        return cls(
            folder=folder,
            name=folder.name,
            command=values.text("command"),
            world=values.text("world"),
            pid=values.number("pid", 2**31),
            domain=values.number("domain", _MAX_DOMAIN, 0),
            page=values.page(),
            start_ns=start_ns,
            navette=values.text("navette"),
            protocol=protocol,
        )


@dataclass(frozen=True)
class _Values:
    """Checked values of an entry that any program of the user may have written."""

    record: dict[str, Any]
    folder: Path

    def text(self, key: str) -> str:
        value = self.record.get(key)
        if isinstance(value, str) and len(value) <= MAX_TEXT and value.isprintable():
            return value
        raise self._refusal(key, f"at most {MAX_TEXT} printable characters")

    def number(self, key: str, at_most: int, default: int | None = None) -> int:
        value = self.record.get(key, default)
        if type(value) is int and 0 <= value <= at_most:
            return value
        raise self._refusal(key, f"a whole number from 0 to {at_most}")

    def page(self) -> str:
        value = self.record.get("page", "")
        if isinstance(value, str) and (value == "" or _PAGE.fullmatch(value)):
            return value
        raise self._refusal("page", "an address such as http://127.0.0.1:8765")

    def _refusal(self, key: str, expected: str) -> FileFormatError:
        found = repr(self.record.get(key))[:60]
        return FileFormatError(self.folder, f"{key} {found}: expected {expected}")
