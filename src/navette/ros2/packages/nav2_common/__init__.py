"""nav2_common: substitutions that Nav2's launch files use."""
