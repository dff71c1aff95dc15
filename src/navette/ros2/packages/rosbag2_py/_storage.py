"""Options and descriptions of bags: rosbag2_py's records."""

from dataclasses import dataclass, field
from enum import IntEnum

from navette.bags import BagTopic, parse_qos
from navette.bags.qos_profiles import profile_of
from navette.runtime import Duration, QoSProfile, Time


@dataclass
class ConverterOptions:
    """Serialization formats; ``cdr`` or "" is possible."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass
class StorageOptions:
    """Where a bag is, and how it is written.

    Attributes:
        uri: folder or file.
        storage_id: ``mcap`` or ``sqlite3``; "": of the file, or ``mcap``.
        max_bagfile_size: bytes of one file of a new bag; 0: no limit.
        max_bagfile_duration: s of one file of a new bag; 0: no limit.
        start_time_ns, end_time_ns: messages that are read; -1: no limit.
    """

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class StorageFilter:
    """Topics that are read: of those listed or matched, without those excluded."""

    topics: list[str] = field(default_factory=list)
    services_events: list[str] = field(default_factory=list)
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    regex_to_exclude: str = ""


class ReadOrderSortBy(IntEnum):
    """Order of messages; Navette reads by ``ReceivedTimestamp``."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass
class ReadOrder:
    """Order of messages and direction."""

    sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


@dataclass
class TopicMetadata:
    """A topic of a bag.

    Attributes:
        offered_qos_profiles: of the recorded publishers, as rclpy's profiles.
    """

    id: int
    name: str
    type: str
    serialization_format: str
    offered_qos_profiles: list[QoSProfile] = field(default_factory=list)
    type_description_hash: str = ""

    def equals(self, other: "TopicMetadata") -> bool:
        return self == other


@dataclass
class TopicInformation:
    """A topic and its number of messages."""

    topic_metadata: TopicMetadata
    message_count: int


@dataclass
class FileInformation:
    """A file of a bag."""

    path: str
    starting_time: Time
    duration: Duration
    message_count: int


@dataclass
class MessageDefinition:
    """Definition of a type, as recorded."""

    topic_type: str
    encoding: str
    encoded_message_definition: str
    type_hash: str


@dataclass
class BagMetadata:
    """What ``metadata.yaml`` states of a bag."""

    version: int = 9
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: Duration = field(default_factory=Duration)
    starting_time: Time = field(default_factory=Time)
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""


def get_default_storage_id() -> str:
    """Return the storage of new bags."""
    return "mcap"


def to_rclcpp_qos_vector(profiles: str, version: int) -> list[QoSProfile]:
    """Parse the text of ``offered_qos_profiles`` of any version of the metadata."""
    return [profile_of(each) for each in parse_qos(profiles)]


def convert_rclcpp_qos_to_rclpy_qos(qos: QoSProfile) -> QoSProfile:
    """Return the profile; profiles of this package are rclpy's already."""
    return qos


def topic_metadata(number: int, topic: BagTopic) -> TopicMetadata:
    """Describe a topic of a reader."""
    return TopicMetadata(
        number,
        topic.name,
        topic.type_name,
        topic.encoding,
        [profile_of(each) for each in topic.qos],
        topic.type_hash,
    )
