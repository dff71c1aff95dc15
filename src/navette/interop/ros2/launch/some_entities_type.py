"""Navette's ``launch.some_entities_type``."""

from navette.launch_files.launch.some_entities_type import (
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
)

__all__ = ["SomeEntitiesType", "SomeEntitiesType_types_tuple"]
