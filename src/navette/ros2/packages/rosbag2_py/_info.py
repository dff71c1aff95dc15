"""Metadata of a bag."""

from pathlib import Path

from navette.bags import BagReader, open_bag
from navette.ros2.packages.rosbag2_py._storage import (
    BagMetadata,
    FileInformation,
    TopicInformation,
    topic_metadata,
)
from navette.runtime import Duration, Time


class Info:
    """Reads the metadata of bags."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Return the metadata of a bag, also of one without ``metadata.yaml``.

        Raises:
            FileFormatError: no bag is there, or it cannot be read.
        """
        with open_bag(Path(uri)) as reader:
            return metadata_of(reader)


def metadata_of(reader: BagReader) -> BagMetadata:
    """Return the metadata of an open bag."""
    counts = reader.counts()
    start = Time(nanoseconds=reader.start_ns)
    duration = Duration(nanoseconds=reader.end_ns - reader.start_ns)
    files = [file.name for file in reader.files]
    total = sum(counts.values())
    return BagMetadata(
        bag_size=reader.size,
        storage_identifier=reader.storage,
        relative_file_paths=files,
        # The span of each file of several is not in the index; that of the bag holds.
        files=[FileInformation(name, start, duration, total) for name in files[:1]]
        if len(files) == 1
        else [],
        duration=duration,
        starting_time=start,
        message_count=total,
        topics_with_message_count=[
            TopicInformation(topic_metadata(number, topic), counts.get(topic, 0))
            for number, topic in enumerate(reader.topics)
        ],
    )
