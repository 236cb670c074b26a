"""The command line `lagrotor`.

`command_line.main` makes the parser, runs one command and returns its exit status. `terminal` contains the parser class,
tables and progress. The commands are in `paper_commands`, `scene_commands` (scenes and structures) and
`benchmark_commands`; `pytest_plugin` makes one test per recorded verdict.

A new command is a function of the parsed arguments that returns an exit status; an `add_…` function adds it with its
options. A refusal is an `InputError` raised before work starts; `main` prints it in one line and returns 2.
"""
