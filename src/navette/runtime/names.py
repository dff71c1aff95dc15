"""Graph resource names: validation, expansion and remapping as in ROS 2.

``/x`` is global, ``x`` relative to the node's namespace, ``~/x`` private to the node
(https://design.ros2.org/articles/topic_and_service_names.html).
"""

import re
from dataclasses import dataclass

from navette.errors import InvalidValueError
from navette.runtime.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)
from navette.runtime.strict_mode import is_strict

TOPIC_SEPARATOR_STRING = "/"
HIDDEN_TOPIC_PREFIX = "_"

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_FORBIDDEN = re.compile(r"[^A-Za-z0-9_/~{}]")
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_MAX_NODE_NAME = 255
_MAX_FULL_NAME = 247
_REMAPPING = re.compile(r"(?:([^:/]+):(?!//))?(?:ros(topic|service)://)?([^:]+)")


def validate_node_name(node_name: str) -> bool:
    """Return True, or raise with the position of the first invalid character."""
    if not node_name:
        raise InvalidNodeNameException(node_name, "must not be empty", 0)
    if len(node_name) > _MAX_NODE_NAME:
        raise InvalidNodeNameException(
            node_name, f"must not be longer than {_MAX_NODE_NAME}", _MAX_NODE_NAME
        )
    bad = re.search(r"[^A-Za-z0-9_]", node_name)
    if bad:
        raise InvalidNodeNameException(
            node_name,
            "must only contain letters, digits and underscores",
            bad.start(),
        )
    if node_name[0].isdigit():
        raise InvalidNodeNameException(node_name, "must not start with a digit", 0)
    return True


def validate_namespace(namespace: str) -> bool:
    """Return True, or raise; a namespace is ``/`` or ``/a/b`` (no trailing slash)."""
    if not namespace.startswith("/"):
        raise InvalidNamespaceException(namespace, "must start with '/'", 0)
    if namespace != "/":
        _check_tokens(namespace, InvalidNamespaceException)
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True, or raise; a full name is ``/…`` without ``~`` and ``{}``."""
    kind = InvalidServiceNameException if is_service else InvalidTopicNameException
    if not name.startswith("/"):
        raise kind(name, "a full name must start with '/'", 0)
    _check_tokens(name, kind)
    if len(name) > _MAX_FULL_NAME and is_strict():
        reason = f"must not be longer than {_MAX_FULL_NAME} characters on ROS 2"
        raise kind(name, reason, _MAX_FULL_NAME)
    return True


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True, or raise; allows relative and private names and substitutions."""
    kind = InvalidServiceNameException if is_service else InvalidTopicNameException
    if not name:
        raise kind(name, "must not be empty", 0)
    bad = _FORBIDDEN.search(name)
    if bad:
        raise kind(
            name,
            "must only contain letters, digits, underscores, '/', '~' and '{}'",
            bad.start(),
        )
    if "~" in name[1:]:
        raise kind(name, "'~' may only come first", name.index("~", 1))
    if name.startswith("~") and name != "~" and not name.startswith("~/"):
        raise kind(name, "'~' must be followed by '/'", 1)
    if name.endswith("/"):
        raise kind(name, "must not end with '/'", len(name) - 1)
    if "//" in name:
        raise kind(name, "must not contain '//'", name.index("//"))
    return True


def topic_or_service_is_hidden(name: str) -> bool:
    tokens = name.split(TOPIC_SEPARATOR_STRING)
    return any(token.startswith(HIDDEN_TOPIC_PREFIX) for token in tokens)


def _check_tokens(name: str, kind: type[NameValidationException]) -> None:
    position = 1
    for token in name[1:].split("/"):
        if not _TOKEN.match(token):
            reason = (
                "each part must only contain letters, digits and underscores and "
                "must not start with a digit"
            )
            raise kind(name, reason, position)  # type: ignore[call-arg] # of its subclasses
        position += len(token) + 1


def expand_topic_name(
    topic_name: str, node_name: str, node_namespace: str, *, is_service: bool = False
) -> str:
    """Return the full name of ``topic_name`` in the node's namespace."""
    validate_topic_name(topic_name, is_service=is_service)
    known = {"node": node_name, "ns": node_namespace, "namespace": node_namespace}

    def substitute(match: re.Match[str]) -> str:
        if match[1] not in known:
            raise InvalidTopicNameException(
                topic_name,
                f"unknown substitution {match[0]}; known: {', '.join(known)}",
                match.start(),
            )
        return known[match[1]]

    name = _SUBSTITUTION.sub(substitute, topic_name)
    prefix = node_namespace.rstrip("/")
    if name.startswith("~"):
        name = f"{prefix}/{node_name}{name[1:]}"
    elif not name.startswith("/"):
        name = f"{prefix}/{name}"
    name = name.replace("//", "/")
    validate_full_topic_name(name, is_service=is_service)
    return name


def full_node_name(node_name: str, namespace: str) -> str:
    """Return ``/ns/node``."""
    return f"{namespace.rstrip('/')}/{node_name}"


def normalize_namespace(namespace: str) -> str:
    """Return the namespace with a leading and no trailing slash; ``/`` if empty."""
    return "/" + namespace.strip("/") if namespace.strip("/") else "/"


@dataclass(frozen=True)
class RemapRule:
    """Rule ``from:=to`` for all nodes, or for the nodes named ``node``."""

    match: str
    replacement: str
    node: str | None = None
    #: "topic", "service", or None for both.
    of: str | None = None

    @classmethod
    def parse(cls, text: str) -> "RemapRule":
        """Parse ``[node:][rostopic://|rosservice://]from:=to``.

        Raises:
            InvalidValueError: the text has another form.
        """
        left, separator, right = text.partition(":=")
        found = _REMAPPING.fullmatch(left)
        if not separator or found is None or not right:
            raise InvalidValueError(
                f"remapping {text!r} must be [node:]from:=to, with from optionally "
                "after rostopic:// or rosservice://"
            )
        node, of, match = found.groups()
        right = right.removeprefix(f"ros{of}://")
        if node is not None:
            validate_node_name(node)
        rule = cls(match, right, node, of)
        rule._validate()
        return rule

    def _validate(self) -> None:
        if self.match in ("__node", "__name"):
            validate_node_name(self.replacement)
        elif self.match == "__ns":
            validate_namespace(normalize_namespace(self.replacement))
        else:
            validate_topic_name(self.match)
            validate_topic_name(self.replacement)

    def applies_to(self, node_name: str) -> bool:
        return self.node is None or self.node == node_name


class NodeRemapper:
    """Remapping rules of one node, local before global; the first match applies."""

    def __init__(self, rules: list[RemapRule], node_name: str, namespace: str) -> None:
        own = [rule for rule in rules if rule.applies_to(node_name)]
        self.node_name = _first(own, ("__node", "__name")) or node_name
        self.namespace = normalize_namespace(_first(own, ("__ns",)) or namespace)
        self._rules = [rule for rule in own if not rule.match.startswith("__")]
        #: Full names of the topics and services that were asked for.
        self._resolved: dict[tuple[str, bool, bool], str] = {}

    def resolve(
        self, name: str, *, is_service: bool = False, only_expand: bool = False
    ) -> str:
        key = name, is_service, only_expand
        if key not in self._resolved:
            self._resolved[key] = self._full_name(*key)
        return self._resolved[key]

    def _full_name(self, name: str, is_service: bool, only_expand: bool) -> str:
        expanded = self._expand(name, is_service=is_service)
        if not only_expand:
            skipped = "topic" if is_service else "service"
            for rule in self._rules:
                if (
                    rule.of != skipped
                    and self._expand(rule.match, is_service=is_service) == expanded
                ):
                    return self._expand(rule.replacement, is_service=is_service)
        return expanded

    def _expand(self, name: str, *, is_service: bool) -> str:
        return expand_topic_name(
            name, self.node_name, self.namespace, is_service=is_service
        )


def _first(rules: list[RemapRule], matches: tuple[str, ...]) -> str | None:
    return next((r.replacement for r in rules if r.match in matches), None)
