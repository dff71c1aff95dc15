"""Is it a namespace?"""

from navette.runtime.names import validate_namespace

__all__ = ["validate_namespace"]
