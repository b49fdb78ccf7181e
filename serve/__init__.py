"""The frame server: sessions, uploads, the browser page, a client, the original's protocol.

Needs Python 3.10, NumPy and websockets: ``board/pyproject.toml`` packages this folder together with ``board/`` as
``voxrt-board``. Inside voxrt it is :mod:`voxrt.serve`.
"""
