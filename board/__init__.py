"""Devices: the register driver, the scene memory, boards over TCP or a serial line, the simulated core, the model."""
