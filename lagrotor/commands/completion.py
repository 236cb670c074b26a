"""`lagrotor completion SHELL`: a script that completes commands, options and choices, made from the parsers themselves."""

import argparse
import shlex
from collections.abc import Iterator

from lagrotor.commands.options import Command

SHELLS = ("bash", "zsh", "fish")


def add_completion(command: Command, parser: argparse.ArgumentParser) -> None:
    """completion, of all that the parser takes by then."""
    added = command(
        "completion",
        lambda given: print(script(parser, given.shell)) or 0,
        "print what completes the command in a shell",
        'eval "$(lagrotor completion bash)"',
    )
    added.description = (
        "Print a script that completes commands, options and choices. In bash or zsh:\n"
        '  eval "$(lagrotor completion bash)"    in ~/.bashrc, with zsh in ~/.zshrc\n'
        "  lagrotor completion fish > ~/.config/fish/completions/lagrotor.fish"
    )
    added.add_argument("shell", choices=SHELLS, metavar="SHELL", help="bash, zsh or fish")


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The script of a shell."""
    words = {name: [word for word, _ in sorted(words_of(each))] for name, each in commands_of(parser)}
    if shell == "fish":
        return "\n".join(_fish(parser))
    cases = "\n".join(f"    {name}) words={shlex.quote(' '.join(each))} ;;" for name, each in words.items())
    lines = ["autoload -U +X bashcompinit && bashcompinit"] if shell == "zsh" else []
    return "\n".join(
        [
            *lines,
            "_lagrotor() {",
            '  local words current="${COMP_WORDS[COMP_CWORD]}"',
            '  case "${COMP_WORDS[1]}" in',
            cases,
            "  esac",
            f'  [ "$COMP_CWORD" -eq 1 ] && words={shlex.quote(" ".join([*words, "--help", "--version"]))}',
            '  COMPREPLY=($(compgen -W "$words" -- "$current"))',
            "}",
            "complete -o default -F _lagrotor lagrotor",
        ]
    )


def commands_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """The commands of a parser by name."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            yield from action.choices.items()


def words_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, str]]:
    """(word, what it does) that may follow a command: its options, the choices of its arguments."""
    for action in parser._actions:
        if not isinstance(action, argparse._SubParsersAction):
            yield from ((word, action.help or "") for word in action.option_strings if word.startswith("--"))
        yield from ((str(choice), "") for choice in action.choices or ())


def _fish(parser: argparse.ArgumentParser) -> Iterator[str]:
    says_of = {action.dest: action.help for each in parser._actions for action in getattr(each, "_choices_actions", ())}
    for name, each in commands_of(parser):
        yield f"complete -c lagrotor -n __fish_use_subcommand -a {name} -d {shlex.quote(says_of.get(name) or '')}"
        for word, says in words_of(each):
            kind = f"-l {word[2:]}" if word.startswith("--") else f"-a {shlex.quote(word)}"
            where = shlex.quote(f"__fish_seen_subcommand_from {name}")
            yield f"complete -c lagrotor -n {where} {kind}" + (f" -d {shlex.quote(says)}" if says else "")
