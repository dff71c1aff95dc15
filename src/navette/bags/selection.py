"""Selection of the topics to record."""

import re
from dataclasses import dataclass

from navette.errors import InvalidNameError, ParameterError
from navette.msgs.registry import full_name

IMAGE_TYPE = "sensor_msgs/msg/Image"


@dataclass(frozen=True)
class TopicSelection:
    """Selects topics by name or pattern; raw images and hidden topics on request.

    A topic is recorded if it is named in ``topics``, matches ``regex`` or has one of
    ``types`` (with none of the three: every topic), and neither matches ``exclude`` nor
    has one of ``exclude_types``. Patterns are Python's and are searched anywhere in
    the full name. A subscribed camera has to render, so raw images require ``images``
    or their name in ``topics``; hidden topics (a part of the name starts with an
    underscore) require ``hidden`` or their name.
    """

    topics: tuple[str, ...] = ()
    regex: str = ""
    exclude: str = ""
    images: bool = False
    types: tuple[str, ...] = ()
    exclude_types: tuple[str, ...] = ()
    hidden: bool = False

    def __post_init__(self) -> None:
        for name in ("types", "exclude_types"):
            for type_name in getattr(self, name):
                _check_type(name, type_name)
        for name in ("regex", "exclude"):
            pattern = getattr(self, name)
            try:
                re.compile(pattern)
            except re.error as error:
                raise ParameterError(
                    f"parameter {name!r}: {pattern!r} is not a regular "
                    f"expression: {error}"
                ) from None

    def takes(self, topic: str, type_name: str) -> bool:
        if topic in self.topics:
            return True
        if self.exclude and re.search(self.exclude, topic):
            return False
        if type_name in self.exclude_types:
            return False
        if type_name == IMAGE_TYPE and not self.images:
            return False
        return self._is_wanted(topic, type_name)

    def _is_wanted(self, topic: str, type_name: str) -> bool:
        if type_name in self.types:
            return True
        if self.regex:
            return re.search(self.regex, topic) is not None
        if self.topics or self.types:
            return False
        return self.hidden or "/_" not in topic


def _check_type(parameter: str, type_name: str) -> None:
    try:
        full_name(type_name)
    except InvalidNameError as error:
        raise ParameterError(f"parameter {parameter!r}: {error}") from None
