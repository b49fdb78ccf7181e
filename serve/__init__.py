"""The frame server: session, uploads, browser page, client library, legacy protocol.

It needs Python 3.10, NumPy and websockets. ``board/pyproject.toml`` packages it together with ``board/`` as
``voxrt-board``. Inside voxrt the package is :mod:`voxrt.serve`.
"""
