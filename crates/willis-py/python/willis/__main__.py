"""The command ``willis``."""

from __future__ import annotations

import sys


def main() -> None:
    """Runs the command with the words of the command line."""
    from . import _willis

    sys.stdout.flush()
    sys.exit(_willis.command(["willis", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
