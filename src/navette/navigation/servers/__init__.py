"""What the nodes of several stages share: servers, and the base class of motion."""
