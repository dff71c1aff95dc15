"""Publish a node's log records on ``/rosout``."""

from navette.msgs.rcl_interfaces.msg import Log
from navette.runtime.log import LogRecord
from navette.runtime.publisher import Publisher
from navette.runtime.time import ns_to_stamp


class RosoutSink:
    """Log sink that publishes the records of one logger and its children."""

    def __init__(self, publisher: Publisher[Log], logger_name: str) -> None:
        self._publisher = publisher
        self._logger_name = logger_name

    def __call__(self, record: LogRecord) -> None:
        name = self._logger_name
        if record.name != name and not record.name.startswith(f"{name}."):
            return
        self._publisher.publish(
            Log(
                stamp=ns_to_stamp(record.stamp_ns),
                level=int(record.severity),
                name=record.name,
                msg=record.message,
                file=record.file,
                function=record.function,
                line=record.line,
            )
        )
