"""Devices: the register driver, the scene memory, the PYNQ board, the simulated core and the exact model.

All but :mod:`~.simulated` needs only Python 3.10 and NumPy. ``board/pyproject.toml`` packages these modules together
with the frame server in ``serve/`` as ``voxrt-board``. Inside voxrt the package is :mod:`voxrt.board`.
"""
