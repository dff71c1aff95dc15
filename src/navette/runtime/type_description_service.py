"""Service ``~/get_type_description``: definitions of message types (REP 2016)."""

from typing import Any

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs import (
    from_dict,
    get_interface,
    interface_text,
    type_description,
    type_hash,
)
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.node_services import NodeServices

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
_PACKAGE = "type_description_interfaces"


class TypeDescriptionService:
    """Serves all types known to this process.

    Disabled by the parameter ``start_type_description_service``.
    """

    def __init__(self, parameters: NodeParameters, services: NodeServices) -> None:
        name = START_TYPE_DESCRIPTION_SERVICE_PARAM
        if not parameters.has_parameter(name):
            descriptor = ParameterDescriptor(
                description="Whether to serve ~/get_type_description.", read_only=True
            )
            parameters.declare_parameter(name, True, descriptor)
        self.enabled: bool = parameters.get_parameter(name).value
        if self.enabled:
            type_name = f"{_PACKAGE}/srv/GetTypeDescription"
            services.serve(type_name, "~/get_type_description", describe)


def describe(request: Any, response: Any) -> Any:
    """Fill in the type description or the failure reason."""
    try:
        found = type_hash(request.type_name)
    except (InvalidNameError, UnknownNameError, FileFormatError) as error:
        response.failure_reason = str(error)
        return response
    if request.type_hash not in ("", found):
        response.failure_reason = (
            f"the type hash of {request.type_name} is {found}, not {request.type_hash}"
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
    """Return the definition texts of the type and of the types it refers to."""
    source = get_interface(f"{_PACKAGE}/msg/TypeSource")
    every = [description.type_description, *description.referenced_type_descriptions]
    return [source(type_name=each.type_name, **_file(each.type_name)) for each in every]


def _file(name: str) -> dict[str, str]:
    text = interface_text(name)
    if text is None:  # a part of a service or an action has no file
        return {"encoding": "implicit", "raw_file_contents": ""}
    return {"encoding": name.split("/")[1], "raw_file_contents": text}
