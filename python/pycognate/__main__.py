"""The command `cognate`; `python -m pycognate ARGUMENTS` is the same."""

import signal
import sys

from . import _core


def main() -> int:
    """Run the command that the arguments of the process name, and return its exit code."""
    program = [sys.executable, "-m", "pycognate"] if sys.executable else ["cognate"]
    # Ctrl-C is the command's, as in a shell: Python would hear it when all is over. Where a shell has it ignored, it stays so.
    is_pythons = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if is_pythons:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        return _core.command(program, sys.argv[1:])
    finally:
        if is_pythons:
            signal.signal(signal.SIGINT, signal.default_int_handler)


if __name__ == "__main__":
    sys.exit(main())
