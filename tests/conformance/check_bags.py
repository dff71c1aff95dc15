"""Compare Navette's reading of recordings with other readers: counts, stamps, values.

    python tests/conformance/check_bags.py FOLDER

goes through every recording in FOLDER with Navette's reader and with ``rosbags``
(``.mcap`` also with ``mcap``) and prints what differs; exits 0 if nothing does.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from navette.bags import open_bag
from navette.bags.checking import check_bag
from navette.bags.message_types import Decoder
from navette.bags.opening import is_bag

Recorded = dict[tuple[str, int], list[Any]]


def recordings(folder: Path) -> Iterator[Path]:
    """Find recordings, recursively."""
    for path in sorted(folder.iterdir()):
        if is_bag(path):
            yield path
        elif path.is_dir():
            yield from recordings(path)


def differences(path: Path) -> list[str]:
    """Return the differences between Navette and ``rosbags``."""
    ours, theirs = read_by_navette(path), read_by_rosbags(path)
    found = [f"navette check: {f.text}" for f in check_bag(path, decode=True).findings]
    counts = [Counter(topic for topic, _ in recorded) for recorded in (ours, theirs)]
    if counts[0] != counts[1]:
        found.append(f"counts: {counts[0]} and {counts[1]}")
    if ours.keys() != theirs.keys():
        found.append(f"stamps: {len(ours.keys() ^ theirs.keys())} differ")
    for key in ours.keys() & theirs.keys():
        if not all(map(same, ours[key], theirs[key])):
            found.append(f"values of {key[0]} at {key[1]} ns")
    if path.suffix == ".mcap":
        found += [f"mcap: {text}" for text in read_by_mcap(path, ours)]
    return found


def read_by_navette(path: Path) -> Recorded:
    """Return messages by topic and stamp."""
    recorded: Recorded = {}
    decoders: dict[Any, Decoder] = {}
    with open_bag(path) as reader:
        for topic, stamp_ns, data in reader.messages():
            decoder = decoders.setdefault(topic, Decoder(topic))
            recorded.setdefault((topic.name, stamp_ns), []).append(decoder(data))
    return recorded


def read_by_rosbags(path: Path) -> Recorded:
    """Return messages by topic and stamp, read by ``rosbags``."""
    recorded: Recorded = {}
    with AnyReader([path]) as reader:
        for connection, stamp_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            recorded.setdefault((connection.topic, stamp_ns), []).append(message)
    return recorded


def read_by_mcap(path: Path, ours: Recorded) -> Iterator[str]:
    """Return the differences to ``mcap``'s counts."""
    with path.open("rb") as file:
        found = Counter(
            (channel.topic, message.log_time)
            for _, channel, message in make_reader(file).iter_messages()
        )
    if found != Counter({key: len(messages) for key, messages in ours.items()}):
        yield "counts or stamps differ"


def same(ours: Any, theirs: Any) -> bool:
    """Whether two messages have the same values, field by field in order."""
    if hasattr(ours, "get_fields_and_field_types"):
        return all(
            same(getattr(ours, name), field_of(theirs, name))
            for name in ours.get_fields_and_field_types()
        )
    if isinstance(ours, str | bool | int | float):
        return bool(ours == theirs) or ours != ours
    if isinstance(ours, bytes):
        return ours == theirs or ours == bytes([theirs])
    if len(ours) != len(theirs):
        return False
    if len(ours) and hasattr(ours[0], "get_fields_and_field_types"):
        return all(map(same, ours, theirs))
    return np.array_equal(np.asarray(ours), np.asarray(theirs))


def field_of(message: Any, name: str) -> Any:
    """Return a field by its ROS 2 name, or its ROS 1 name, which may have capitals."""
    return getattr(message, name if hasattr(message, name) else name.upper())


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    wrong = 0
    for path in recordings(parser.parse_args().folder):
        found = differences(path)
        wrong += bool(found)
        sys.stdout.write(f"{path}: {'; '.join(found[:10]) or 'the same'}\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
