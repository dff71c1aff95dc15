"""The parts of the costmap node with a file of their own."""
