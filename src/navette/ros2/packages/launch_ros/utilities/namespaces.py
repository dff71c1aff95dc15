"""Relative and absolute namespaces."""

from typing import overload


def is_root_namespace(ns: str) -> bool:
    """Whether a namespace is ``/``."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Whether a namespace begins with ``/``."""
    return ns.startswith("/")


@overload
def make_namespace_absolute(ns: str) -> str: ...
@overload
def make_namespace_absolute(ns: None) -> None: ...
def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a namespace that begins with ``/``; None stays None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Join namespaces without a trailing slash; an absolute ``ns`` stays as it is.

    None is a namespace that is not given; it adds nothing.
    """
    if ns is None:
        joined = base_ns
    elif not base_ns or is_namespace_absolute(ns):
        joined = ns
    else:
        joined = f"{'' if is_root_namespace(base_ns) else base_ns}/{ns}"
    if joined is None or is_root_namespace(joined):
        return joined
    return joined.rstrip("/")
