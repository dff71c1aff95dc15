"""Is it a namespace?"""

from navette.runtime.exceptions import InvalidNamespaceException
from navette.runtime.names import validate_namespace

__all__ = [
    "InvalidNamespaceException",
    "validate_namespace",
]
