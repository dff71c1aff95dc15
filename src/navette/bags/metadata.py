"""Write rosbag2's ``metadata.yaml`` (version 8, Jazzy)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.bags.bag import BagTopic
from navette.bags.qos import qos_text

VERSION = 8
_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


@dataclass
class FileFacts:
    """Statistics of a file of the folder; stamps of its first and last message."""

    name: str
    start_ns: int = 0
    end_ns: int = 0
    count: int = 0

    def add(self, stamp_ns: int) -> None:
        self.start_ns = min(self.start_ns, stamp_ns) if self.count else stamp_ns
        self.end_ns = max(self.end_ns, stamp_ns) if self.count else stamp_ns
        self.count += 1


def information(
    files: Sequence[FileFacts],
    topics: Sequence[tuple[BagTopic, int]],
    *,
    storage: str = "mcap",
    compression: str = "",
) -> dict[str, Any]:
    """Return the content of the key ``rosbag2_bagfile_information``.

    Args:
        topics: with the number of their messages.
        compression: of whole files: ``zstd`` or "".
    """
    filled = [each for each in files if each.count]
    start = min((each.start_ns for each in filled), default=0)
    end = max((each.end_ns for each in filled), default=0)
    return {
        "version": VERSION,
        "storage_identifier": storage,
        **_span(start, end, sum(each.count for each in files)),
        "topics_with_message_count": [
            {"topic_metadata": _topic(topic), "message_count": count}
            for topic, count in topics
        ],
        "compression_format": compression,
        "compression_mode": "file" if compression else "",
        "relative_file_paths": [each.name for each in files],
        "files": [
            {"path": each.name, **_span(each.start_ns, each.end_ns, each.count)}
            for each in files
        ],
        "custom_data": None,
        "ros_distro": "navette",
    }


def write_metadata(
    folder: Path,
    files: Sequence[FileFacts],
    topics: Sequence[tuple[BagTopic, int]],
    *,
    storage: str = "mcap",
    compression: str = "",
) -> None:
    """Write the metadata of a folder atomically.

    Raises:
        OSError: the disk is full.
    """
    found = information(files, topics, storage=storage, compression=compression)
    text = yaml.dump(
        {"rosbag2_bagfile_information": found}, Dumper=_DUMPER, sort_keys=False
    )
    part = folder / ".metadata.yaml.part"
    part.write_text(text, "utf-8")
    part.replace(folder / "metadata.yaml")


def _span(start_ns: int, end_ns: int, count: int) -> dict[str, Any]:
    return {
        "duration": {"nanoseconds": end_ns - start_ns},
        "starting_time": {"nanoseconds_since_epoch": start_ns},
        "message_count": count,
    }


def _topic(topic: BagTopic) -> dict[str, Any]:
    return {
        "name": topic.name,
        "type": topic.type_name,
        "serialization_format": topic.encoding,
        "offered_qos_profiles": qos_text(topic.qos),
        "type_description_hash": topic.type_hash,
    }
