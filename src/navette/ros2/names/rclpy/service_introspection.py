"""Services that publish what they do."""

from navette.runtime.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
