"""Base of the stages: inputs, outputs, parameters, robot pose and status."""
