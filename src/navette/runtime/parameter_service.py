"""Services that read and set a node's parameters."""

from typing import Any

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import SetParametersResult
from navette.runtime.exceptions import (
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from navette.runtime.node_parameters import NodeParameters
from navette.runtime.node_services import NodeServices
from navette.runtime.parameter import Parameter
from navette.runtime.qos import qos_profile_parameters


class ParameterService:
    """Server of ``~/get_parameters``, ``~/set_parameters`` and the other services."""

    def __init__(self, parameters: NodeParameters, services: NodeServices) -> None:
        self._parameters = parameters
        for type_name, name, callback in (
            ("DescribeParameters", "describe_parameters", self._describe),
            ("GetParameters", "get_parameters", self._get),
            ("GetParameterTypes", "get_parameter_types", self._get_types),
            ("ListParameters", "list_parameters", self._list),
            ("SetParameters", "set_parameters", self._set),
            ("SetParametersAtomically", "set_parameters_atomically", self._set_all),
        ):
            services.serve(
                f"rcl_interfaces/srv/{type_name}",
                f"~/{name}",
                callback,
                qos_profile=qos_profile_parameters,
            )

    # As in ROS 2, the response is empty if one of the names does not exist.

    def _describe(self, request: Any, response: Any) -> Any:
        try:
            response.descriptors = self._parameters.describe_parameters(request.names)
        except ParameterNotDeclaredException:
            response.descriptors = []
        return response

    def _get(self, request: Any, response: Any) -> Any:
        try:
            found = self._parameters.get_parameters(request.names)
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            found = []
        response.values = [parameter.get_parameter_value() for parameter in found]
        return response

    def _get_types(self, request: Any, response: Any) -> Any:
        try:
            kinds = self._parameters.get_parameter_types(request.names)
        except ParameterNotDeclaredException:
            kinds = []
        response.types = [int(kind) for kind in kinds]
        return response

    def _list(self, request: Any, response: Any) -> Any:
        response.result = self._parameters.list_parameters(
            request.prefixes, request.depth
        )
        return response

    def _set(self, request: Any, response: Any) -> Any:
        response.results = [self._try_set([each]) for each in request.parameters]
        return response

    def _set_all(self, request: Any, response: Any) -> Any:
        response.result = self._try_set(request.parameters)
        return response

    def _try_set(self, messages: list[Any]) -> SetParametersResult:
        """Set the parameters; report an invalid request to the client only."""
        try:
            parameters = [Parameter.from_parameter_msg(each) for each in messages]
            return self._parameters.set_parameters_atomically(parameters)
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
