"""Who may use the live view: the user who runs it, and clients with a token.

Programs of the same user need no token: on this machine the kernel reports whose
connection it is (:mod:`navette.viewer.peer_user`). All other clients present a token,
or, with encryption, a certificate of the same authority.
"""

import hashlib
import hmac
import secrets
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass
from urllib.parse import parse_qs, urlsplit

from navette.errors import InvalidValueError
from navette.viewer.peer_user import is_trusted
from navette.viewer.token_bucket import TokenBucket
from navette.viewer.wall_clock import WallClock
from navette.viewer.web import HttpResponse, refuse

TOKEN_VARIABLE = "NAVETTE_VIEW_TOKEN"
_SHORTEST = 12  # characters
# Wrong tokens of one address.
_FAILURE_BURST, _FAILURES_PER_S = 10, 0.2
_MAX_ADDRESSES = 1000


@dataclass(frozen=True)
class Visitor:
    """The origin of a request.

    Args:
        address: IP address.
        user: user id of a program of this machine, according to the kernel.
        has_certificate: presented a certificate that the server's authority signed.
    """

    address: str
    user: int | None = None
    has_certificate: bool = False


class Login:
    """Accepts visitors by user, certificate or token.

    Args:
        tokens: accepted tokens.
        is_required: false accepts everyone.
    """

    def __init__(
        self,
        tokens: Iterable[str],
        clock: WallClock,
        *,
        is_required: bool = True,
    ) -> None:
        self._digests = [_digest(token) for token in tokens]
        self._clock = clock
        self._is_required = is_required
        self._failures: OrderedDict[str, TokenBucket] = OrderedDict()

    def is_known(self, token: str) -> bool:
        """Compare in constant time with all tokens."""
        digest, known = _digest(token), False
        for each in self._digests:
            known |= hmac.compare_digest(digest, each)
        return known

    def refusal(self, visitor: Visitor, token: str | None) -> HttpResponse | None:
        """Return the response to a visitor who is not accepted, else None."""
        if not self._is_required or is_trusted(visitor.user) or visitor.has_certificate:
            return None
        if token is None:
            return refuse(
                401,
                "a token is required: use the address that the program prints, or add "
                "?token=TOKEN",
            )
        return self.token_refusal(visitor, token)

    def token_refusal(self, visitor: Visitor, token: str) -> HttpResponse | None:
        """Return the response to a wrong token, None for a right one.

        Each address may be wrong a limited number of times.
        """
        failures = self._failures.get(visitor.address)
        if failures is not None and failures.wait_s() > 0:
            wait_s = failures.wait_s()
            return refuse(429, f"too many wrong tokens; wait {wait_s:.0f} s")
        if self.is_known(token):
            return None
        self._count_failure(visitor.address)
        return refuse(401, "wrong token")

    def _count_failure(self, address: str) -> None:
        bucket = self._failures.pop(address, None)
        if bucket is None:
            bucket = TokenBucket(_FAILURES_PER_S, _FAILURE_BURST - 1, self._clock)
            if len(self._failures) >= _MAX_ADDRESSES:
                self._failures.popitem(last=False)
        bucket.take(1)
        self._failures[address] = bucket


def new_token(configured: str | None) -> str:
    """Return the configured token, or a random one.

    Raises:
        InvalidValueError: the token is too short to be secret.
    """
    if not configured:
        return secrets.token_urlsafe(16)
    if len(configured) < _SHORTEST or not configured.isascii():
        raise InvalidValueError(
            f"{TOKEN_VARIABLE}: expected at least {_SHORTEST} ASCII characters; unset "
            "it for a random token"
        )
    return configured


def token_of(target: str, authorization: str | None) -> str | None:
    """Return the token of a request: ``?token=`` or ``Authorization: Bearer``."""
    if authorization is not None:
        scheme, _, token = authorization.partition(" ")
        if scheme.lower() == "bearer" and token.strip():
            return token.strip()
    try:
        values = parse_qs(urlsplit(target).query, max_num_fields=16).get("token")
    except ValueError:
        return None
    return values[0] if values else None


def _digest(token: str) -> bytes:
    # Of equal length, so that a comparison does not depend on the token's.
    return hashlib.sha256(token.encode(errors="replace")).digest()
