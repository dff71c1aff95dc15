"""The robot as the nodes of a behaviour tree access it."""
