"""What the viewer says where it cannot draw."""


class ViewerError(Exception):
    """PyVista is not installed, or there is no screen to open a window on; in one line."""
