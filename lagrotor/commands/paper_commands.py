"""The commands about the paper: reproduce, audit, claims, figure. Exit status 1 when a verdict is not as recorded."""

import argparse
from collections import Counter
from collections.abc import Collection
from pathlib import Path

from lagrotor.commands.options import Command, check_folder
from lagrotor.commands.terminal import progress, say, table, wrapped
from lagrotor.errors import InputError


def add_paper_commands(command: Command) -> None:
    """reproduce, audit, claims, figure."""
    added = command(
        "reproduce",
        reproduce_command,
        "judge every equation, draw every figure, write the report",
        "lagrotor reproduce --out report",
    )
    added.add_argument("--out", type=Path, default=Path("report"), metavar="DIR", help="folder (default: report)")
    added.add_argument("--jobs", type=int, metavar="N", help="processes (default: one a core, one in a debugger)")

    added = command("audit", audit_command, "judge the paper's equations", "lagrotor audit 5.12 5.15 --json")
    added.description = "Judge the paper's equations. For single ids only their own derivations run."
    added.add_argument("ids", nargs="*", metavar="ID", help="equations, such as 5.15 (default: all that are judged)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object an equation")

    added = command("claims", claims_command, "test the paper's claims", "lagrotor claims C08 C22 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="claims, such as C08 (default: all)")
    added.add_argument("--json", action="store_true", help="print a JSON list, one object a claim")

    added = command("figure", figure_command, "draw figures as SVG and PNG", "lagrotor figure 17 t6 --out .")
    added.add_argument(
        "keys", nargs="+", metavar="N", help="the paper's figure number, or the name of another: t1 to t10, b1, m1"
    )
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")


def reproduce_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.record import recorded
    from lagrotor.report.content import counted
    from lagrotor.report.formulas.mathml_latex import converter
    from lagrotor.report.job.reproduce import reproduce

    made = reproduce(given.out, progress, given.jobs)
    page = given.out / "index.html"
    judged = sum(made.equations.values())
    print(f"{judged} equations judged: {counted(made.equations) or 'none'}; {made.waiting} not yet judged")
    if made.claims:
        print(f"{sum(made.claims.values())} claims tried: {counted(made.claims)}")
    if made.taken == ["report"]:
        print("all taken from the last run (same inputs); to run it again, delete the folder")
    elif made.taken:
        kinds = Counter(name.split()[0] for name in made.taken)
        parts = ", ".join(f"{count} {kind}{'s' * (count > 1)}" for kind, count in kinds.items())
        print(f"{parts} taken from the last run (same inputs)")
    print(f"{made.figures} figures; {made.seconds:.1f} s; report: {page}")
    if not converter():
        print("the page shows printed equations as LaTeX source; to see them typeset: pip install 'lagrotor[report]'")
    return _compared(made.changes, bool(recorded()))


def audit_command(given: argparse.Namespace) -> int:
    from lagrotor.paper import audit, scripts
    from lagrotor.paper.catalogue import equations
    from lagrotor.paper.record import changes, recorded
    from lagrotor.report.content import note, word

    identifiers = [_known(identifier, equations()) for identifier in given.ids]
    with progress(len(identifiers) or len(scripts.names("derivations", "s"))) as step:
        shown = [audit.audit(i, step) for i in identifiers] if identifiers else list(audit.audit(progress=step))
    if given.json:
        print(audit.to_json(shown))
    elif identifiers:
        print("\n\n".join(map(audit.in_words, shown)))
    else:
        rows = [(v.id, word(v.verdict), ": ".join(filter(None, (equations()[v.id].title, note(v))))) for v in shown]
        print(table(("id", "verdict", "equation: order, premises"), rows))
    on_record = recorded()
    return _compared(changes({v.id: v.verdict for v in shown}, on_record, identifiers or equations()), bool(on_record))


def _known(identifier: str, ids: Collection[str]) -> str:
    """An id that the paper has. Raises InputError that names near ones: 5.1 may be 5.01 or 5.10."""
    if identifier in ids:
        return identifier
    section, _, place = identifier.rpartition(".")
    near = [i for i in (f"{section}.0{place}", f"{section}.{place}0", f"C{identifier.lstrip('Cc'):0>2}") if i in ids]
    first, last = next(iter(ids)), list(ids)[-1]
    hint = f"{' or '.join(near)}?" if near else f"ids run from {first} to {last}"
    raise InputError(f"{identifier!r} is not in the catalogue: {hint}")


def claims_command(given: argparse.Namespace) -> int:
    from lagrotor.paper import claim_tests
    from lagrotor.paper.catalogue import claims
    from lagrotor.paper.record import changes, recorded
    from lagrotor.report.content import word

    wanted = frozenset(_known(identifier, claims()) for identifier in given.ids) or frozenset(claims())
    with progress(len(wanted)) as step:
        results = claim_tests.evaluate(step, wanted)
    if given.json:
        print(claim_tests.to_json(results))
    else:
        for result in results:
            identifier, finding = result.test.id, result.finding
            print(wrapped(f"{identifier}  {claims()[identifier].text}", 5))
            print(wrapped(f"     {word(finding.outcome)}: {finding.explanation}", 5), end="\n\n")
    on_record = recorded()
    return _compared(changes({r.test.id: r.finding.outcome for r in results}, on_record, wanted), bool(on_record))


def figure_command(given: argparse.Namespace) -> int:
    from lagrotor.pictures.figures import check_keys, draw

    check_folder(given.out)
    keys = check_keys(given.keys)
    with progress(len(keys)) as step:
        for key in keys:
            step(f"figure {key}")
            picture = draw(key, given.out)
            print(picture.svg, picture.png, sep="\n")
    return 0


def _compared(changes: list[str], on_record: bool) -> int:
    if not on_record:
        return say("no verdicts are on record yet: nothing to compare these with", 0)
    for change in changes:
        say(f"changed: {change}", 1)
    return 1 if changes else 0
