"""`python -m lagrotor` is the command `lagrotor`."""

import sys

from lagrotor.commands.command_line import main

sys.exit(main())
