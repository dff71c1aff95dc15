"""Decides on every request: page, file, WebSocket or refusal."""

from dataclasses import dataclass

from navette.viewer.login import Login, Visitor, token_of
from navette.viewer.problem_reports import ProblemReports
from navette.viewer.web import AccessPolicy, HttpResponse, Site, refuse

_MAX_NOTES = 16  # refused origins that are reported


@dataclass(frozen=True)
class WebRequest:
    """The parts of an HTTP request that decide about it."""

    method: str
    target: str
    host: str | None
    origin: str | None
    authorization: str | None
    visitor: Visitor
    encodings: str = ""


class Gate:
    """Checks host, login and origin of a request, in this order."""

    def __init__(
        self,
        policy: AccessPolicy,
        login: Login,
        site: Site,
        *,
        problems: ProblemReports,
    ) -> None:
        self._policy, self._login, self._site = policy, login, site
        self._problems = problems
        self._noted: set[str] = set()

    def page(self, request: WebRequest) -> HttpResponse:
        """Return the response to a request that opens no socket.

        The page and its scripts are the same everywhere and need no login; with them
        a browser requests the token.
        """
        refused = self._policy.host_refusal(request.host)
        if refused:
            return refuse(403, refused)
        refused_login = None
        if not self._site.is_public(request.target):
            refused_login = self.refusal(request)
        return refused_login or self._site.answer(
            request.method, request.target, request.encodings
        )

    def refusal(self, request: WebRequest) -> HttpResponse | None:
        """Return the response to a request that is refused, else None."""
        refused = self._policy.host_refusal(request.host)
        if refused:
            return refuse(403, refused)
        token = token_of(request.target, request.authorization)
        denied = self._login.refusal(request.visitor, token)
        if denied is not None:
            if request.visitor.user is not None:
                self._problems.user_refused()
            return denied
        refused = self._policy.origin_refusal(request.origin, request.host)
        if not refused:
            return None
        # A page that has the token needs no other permission.
        if token is not None:
            return self._login.token_refusal(request.visitor, token)
        if request.origin not in self._noted and len(self._noted) < _MAX_NOTES:
            self._noted.add(str(request.origin))
            self._problems.origin_refused(refused)
        return refuse(403, refused)
