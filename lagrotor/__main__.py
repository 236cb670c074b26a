"""`python -m lagrotor` is the command `lagrotor`."""

import sys

from .commands.command_line import main

sys.exit(main())
