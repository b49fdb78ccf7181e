"""What sim says when it cannot render."""


class SimulatorError(Exception):
    """The simulator is missing, refuses the memory or the camera, or disagrees with the model."""
