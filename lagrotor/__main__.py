"""`python -m lagrotor` is the command `lagrotor`."""

import sys

from .report.command_line import main

sys.exit(main())
