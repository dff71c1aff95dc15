"""``~/get_type_description``: every node tells others what its types are (REP 2016)."""

from typing import TYPE_CHECKING, Any

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs import (
    from_dict,
    get_interface,
    interface_text,
    type_description,
    type_hash,
)
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor

if TYPE_CHECKING:
    from navette.runtime.node import Node

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
_PACKAGE = "type_description_interfaces"


class TypeDescriptionService:
    """Serves it, unless the parameter ``start_type_description_service`` is false.

    It knows every type that is defined here, those that the node uses among them.
    """

    def __init__(self, node: "Node") -> None:
        name = START_TYPE_DESCRIPTION_SERVICE_PARAM
        if not node.has_parameter(name):
            descriptor = ParameterDescriptor(
                description="Whether to serve ~/get_type_description.", read_only=True
            )
            node.declare_parameter(name, True, descriptor)
        self.enabled: bool = node.get_parameter(name).value
        if self.enabled:
            type_name = f"{_PACKAGE}/srv/GetTypeDescription"
            node.serve(type_name, "~/get_type_description", describe)


def describe(request: Any, response: Any) -> Any:
    """Fill in the response, or why there is none."""
    try:
        found = type_hash(request.type_name)
    except (InvalidNameError, UnknownNameError, FileFormatError) as error:
        response.failure_reason = str(error)
        return response
    if request.type_hash not in ("", found):
        response.failure_reason = (
            f"{request.type_name} is {found} here, not {request.type_hash}"
        )
        return response
    description = type_description(request.type_name)
    kind = get_interface(f"{_PACKAGE}/msg/TypeDescription")
    response.type_description = from_dict(kind, description)
    if request.include_type_sources:
        response.type_sources = _sources(response.type_description)
    response.successful = True
    return response


def _sources(description: Any) -> list[Any]:
    """The text of the type's own file and of the files of what it refers to."""
    source = get_interface(f"{_PACKAGE}/msg/TypeSource")
    every = [description.type_description, *description.referenced_type_descriptions]
    return [source(type_name=each.type_name, **_file(each.type_name)) for each in every]


def _file(name: str) -> dict[str, str]:
    text = interface_text(name)
    if text is None:  # a part of a service or an action: made from it
        return {"encoding": "implicit", "raw_file_contents": ""}
    return {"encoding": name.split("/")[1], "raw_file_contents": text}
