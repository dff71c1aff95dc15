"""Navette's ``launch.some_substitutions_type``."""

from navette.launch_files.launch.some_substitutions_type import (
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
)

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
