"""Kinds of drives of a wheeled base, by the motions that they allow."""

DIFFERENTIAL, ACKERMANN, OMNI = "differential", "ackermann", "omni"

DRIVES = (DIFFERENTIAL, ACKERMANN, OMNI)
"""Turns in place; drives arcs of a least radius; also moves sideways."""
