"""What runs on the board, or stands in for it: device, scene memory, frame server, browser page.

Needs Python 3.10, NumPy and websockets, and nothing else of voxrt: ``board/pyproject.toml`` packages this folder alone
as ``voxrt-board``. Inside voxrt it is :mod:`voxrt.board`.
"""
