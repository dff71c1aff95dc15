"""The robot's stages, in the order data flows, and the stack that wires them."""
