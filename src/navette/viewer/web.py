"""Plain HTTP on the viewer's port: access policy and pages."""

import ipaddress
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol
from urllib.parse import urlsplit

from navette.viewer.page_files import PageFile

_LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")
# Names that only a local network assigns; a page on the internet cannot have them.
_LOCAL_SUFFIXES = (".localhost", ".local", ".lan", ".home.arpa", ".internal")

PAGE_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data: blob:; connect-src 'self' ws: wss:; manifest-src 'self'; "
    "worker-src 'self'; frame-src blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'"
)


@dataclass(frozen=True)
class HttpResponse:
    status: int
    content_type: str
    body: bytes
    headers: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class AccessPolicy:
    """The hosts and origins that may connect to this server.

    A page from the internet must not drive the robot. Browsers send the page's origin
    when it opens a socket, and a page whose own name resolves to this machine (DNS
    rebinding) is visible in the Host header.
    """

    bound_host: str
    allowed_origins: tuple[str, ...]
    allowed_hosts: tuple[str, ...] = ()

    def host_refusal(self, host: str | None) -> str:
        """Return why the Host header is refused; empty if it is allowed."""
        if host is None or self._host_allowed(host):
            return ""
        return (
            f"host {host!r:.120} is not allowed: use localhost or 127.0.0.1, or add "
            "the name to the viewer's parameter allowed_hosts"
        )

    def origin_refusal(self, origin: str | None, host: str | None) -> str:
        """Return why a page's origin is refused; empty if it is allowed.

        Programs other than browsers send no origin.
        """
        if origin is None or self._origin_allowed(origin, host):
            return ""
        return (
            f"origin {origin!r:.120} is not allowed: add it to the viewer's parameter "
            "allowed_origins, or connect with a token"
        )

    def _host_allowed(self, host: str) -> bool:
        name = _name_of(f"//{host}")
        if name in self.allowed_hosts or name in _LOOPBACK_NAMES:
            return True
        if self.bound_host in _LOOPBACK_NAMES:
            return False
        return _is_address(name) or "." not in name or name.endswith(_LOCAL_SUFFIXES)

    def _origin_allowed(self, origin: str, host: str | None) -> bool:
        if "*" in self.allowed_origins or origin in self.allowed_origins:
            return True
        return host is not None and origin in (f"http://{host}", f"https://{host}")


def _name_of(address: str) -> str:
    try:
        return (urlsplit(address).hostname or "").lower()
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


class SiteDocuments(Protocol):
    """The documents of the site that change; requested on the socket thread."""

    def layout(self) -> Mapping[str, Any]:
        """Return ``/layout.json``, a layout of the Foxglove app."""

    def health(self) -> Mapping[str, Any]:
        """Return ``/health``: status, version and counts."""


class Site:
    """Serves the page's files, ``/layout.json`` and ``/health``; 404 for other paths.

    Args:
        files: the page by path.
    """

    def __init__(self, files: Mapping[str, PageFile], documents: SiteDocuments) -> None:
        self._files = files
        self._documents = documents

    def is_public(self, target: str) -> bool:
        """Whether a path is the same for every program: a file of the page."""
        return target.partition("?")[0] in self._files

    def answer(self, method: str, target: str, encodings: str = "") -> HttpResponse:
        """Return the response to a request.

        Args:
            encodings: the request's Accept-Encoding header.
        """
        if method not in ("GET", "HEAD"):
            return refuse(405, f"method {method} is not allowed; use GET")
        answer = self._answer(target.partition("?")[0], encodings)
        if method == "HEAD":
            return HttpResponse(answer.status, answer.content_type, b"", answer.headers)
        return answer

    def _answer(self, path: str, encodings: str) -> HttpResponse:
        if path in self._files:
            return _file_response(self._files[path], encodings)
        if path == "/layout.json":
            download = 'attachment; filename="navette-layout.json"'
            headers = {"Content-Disposition": download}
            body = json.dumps(self._documents.layout(), indent=2).encode()
            return HttpResponse(200, "application/json", body, headers)
        if path == "/health":
            body = json.dumps(self._documents.health()).encode()
            return HttpResponse(200, "application/json", body)
        return refuse(404, f"nothing at {path!r:.120}; known: /, /layout.json, /health")


def _file_response(file: PageFile, encodings: str) -> HttpResponse:
    headers = {}
    if file.content_type.startswith("text/html"):
        headers["Content-Security-Policy"] = PAGE_POLICY
    if "gzip" in encodings and len(file.compressed) < len(file.body):
        headers |= {"Content-Encoding": "gzip", "Vary": "Accept-Encoding"}
        return HttpResponse(200, file.content_type, file.compressed, headers)
    return HttpResponse(200, file.content_type, file.body, headers)


def refuse(status: int, reason: str) -> HttpResponse:
    return HttpResponse(status, "text/plain; charset=utf-8", f"{reason}\n".encode())
