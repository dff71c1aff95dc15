"""``navette up`` and its companions: services described in ``navette.yaml``."""
