"""The command ``rc`` of the wheel."""

import signal
import sys

from roughcontact import _core


def main() -> int:
    """Runs the command line of this process."""
    # Ctrl-C ends the process, or is caught by the command itself; Python would only take note of it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.main(["rc", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
