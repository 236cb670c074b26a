"""The command line `lagrotor`.

`command_line.main` makes the parser, runs one command and returns its exit status. `terminal` contains the parser class,
the tables and the display of progress. The commands are in `paper_commands`, `scene_commands` (scenes and structures)
and `benchmark_commands`; `pytest_plugin` makes one test of each recorded verdict.

A new command is a function of the parsed arguments that returns an exit status. An `add_…` function adds it, with its
options, to the parser. Bad input raises an `InputError` before work starts; `main` prints it in one line and returns 2.
"""
