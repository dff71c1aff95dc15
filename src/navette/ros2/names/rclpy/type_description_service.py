"""What types are, for others."""

from navette.runtime.type_description_service import (
    START_TYPE_DESCRIPTION_SERVICE_PARAM,
    TypeDescriptionService,
)

__all__ = [
    "START_TYPE_DESCRIPTION_SERVICE_PARAM",
    "TypeDescriptionService",
]
