"""Clients' calls of services. All methods belong to the executor's thread."""

import json
import math
from functools import partial
from typing import Any

from navette.errors import NavetteError
from navette.msgs import get_interface, serialize, to_dict
from navette.viewer.offered_services import OfferedServices
from navette.viewer.publishing import decode_message
from navette.viewer.replies import OfferedService
from navette.viewer.service_calls import ServiceCalls
from navette.viewer.session import CallId
from navette.viewer.thread_bridge import ThreadBridge

TIMEOUT_S = 30.0  # a service may compute or move something before it responds


class ServiceRequests:
    """Calls services for clients; each call is answered once, in its own encoding."""

    def __init__(
        self,
        offered: OfferedServices,
        service_calls: ServiceCalls,
        *,
        bridge: ThreadBridge,
    ) -> None:
        self._offered, self._service_calls = offered, service_calls
        self._bridge = bridge

    def call(
        self, call_id: CallId, service: OfferedService, encoding: str, data: bytes
    ) -> None:
        """Decode the request, call the service and forward its response."""
        try:
            interface: Any = get_interface(service.type_name)
            request = decode_message(encoding, interface.Request, data)
        except NavetteError as error:
            self._fail(call_id, f"{service.name}: {error}")
            return
        self._service_calls.call(
            service.name,
            service.type_name,
            request,
            partial(self._forward, call_id, service.name, encoding),
            timeout_s=TIMEOUT_S,
        )

    def _forward(
        self, call_id: CallId, name: str, encoding: str, response: Any, reason: str
    ) -> None:
        if response is None:
            self._fail(call_id, f"{name}: {reason}")
            return
        data = serialize(response) if encoding == "cdr" else _json_of(response)
        self._bridge.call_hub(self._offered.responded, call_id, encoding, data)

    def _fail(self, call_id: CallId, reason: str) -> None:
        self._bridge.call_hub(self._offered.failed, call_id, reason)


def _json_of(response: Any) -> bytes:
    return json.dumps(_finite(to_dict(response)), allow_nan=False).encode()


def _finite(value: Any) -> Any:
    """Replace NaN and infinity, which JSON does not have, by null."""
    if isinstance(value, dict):
        return {name: _finite(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
