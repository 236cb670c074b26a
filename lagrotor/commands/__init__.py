"""The command line `lagrotor`.

`command_line.main` makes the parser, runs one command and returns its exit status. `terminal` has the parser's class, tables
and progress. The commands are in `paper_commands`, `scene_commands` (scenes and structures) and `benchmark_commands`;
`pytest_plugin` makes a test of each recorded verdict.

To add a command, write a function of the parsed arguments that returns an exit status, and add it with its options in an
`add_…` function. A refusal is an `InputError` raised before work starts; `main` prints it in one line and returns 2.
"""
