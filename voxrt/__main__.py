"""``python -m voxrt`` is ``voxrt``."""

from voxrt.cli import main

if __name__ == "__main__":
    main()
