"""Stages of the navigation stack in data-flow order, and the stack that wires them."""
