"""Publishers."""

from navette.runtime.publisher import Publisher

__all__ = ["Publisher"]
