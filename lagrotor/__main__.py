"""`python -m lagrotor` is the command `lagrotor`.

An interrupt while the package loads, or after the command has ended, stops the process without a traceback. In between
`main` reports it in words.
"""

import gc
import signal
import sys


def start() -> int:
    """Load the command line, run it, and return its exit status."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from lagrotor.commands.command_line import main

    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        return main()
    except KeyboardInterrupt:  # a second one, while the first is reported
        return 130
    finally:
        gc.freeze()  # at its end Python would search all modules for garbage, as long as it takes to import half of sympy
        signal.signal(signal.SIGINT, signal.SIG_DFL)


if __name__ == "__main__":
    sys.exit(start())
