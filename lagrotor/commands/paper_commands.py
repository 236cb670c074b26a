"""The commands that judge the paper: reproduce, audit, claims. Exit status 1 when a verdict is not as recorded."""

import argparse
from collections import Counter
from typing import TYPE_CHECKING

from lagrotor.commands.terminal import progress, say, table, wrapped
from lagrotor.errors import InputError

if TYPE_CHECKING:
    from lagrotor.paper.ledger import Statement

_LONGEST = 100  # characters of a correction that is shown in a terminal


def reproduce_command(given: argparse.Namespace) -> int:
    from lagrotor.report.content import told
    from lagrotor.report.formulas.mathml_latex import converter
    from lagrotor.report.reproduce import recorded, reproduce

    made = reproduce(given.out, progress)
    page = given.out / "index.html"
    judged = sum(made.equations.values())
    print(f"{judged} equations judged: {told(made.equations) or 'none'}; {made.waiting} not yet judged")
    if made.claims:
        print(f"{sum(made.claims.values())} claims tried: {told(made.claims)}")
    if made.taken == ["report"]:
        print("all taken from the last run (same inputs); to run it again, delete the folder")
    elif made.taken:
        kinds = Counter(name.split()[0] for name in made.taken)
        parts = ", ".join(f"{count} {kind}{'s' * (count > 1)}" for kind, count in kinds.items())
        print(f"{parts} taken from the last run (same inputs)")
    print(f"{made.figures} figures; {made.seconds:.1f} s; report: {page}")
    if not converter():
        print("the page shows printed equations as LaTeX source; to see them typeset: pip install 'lagrotor[report]'")
    return _compared(made.changes, recorded())


def audit_command(given: argparse.Namespace) -> int:
    from lagrotor.paper import audit, scripts
    from lagrotor.paper.catalogue import equation, equations
    from lagrotor.report.content import note, word
    from lagrotor.report.reproduce import changes, outcomes, recorded

    for identifier in given.ids:
        equation(identifier)
    with progress(len(scripts.names("derivations", "s"))) as step:
        verdicts = audit.audit(step)
    judged = {verdict.id for verdict in verdicts}
    if waiting := [i for i in given.ids if i not in judged]:
        raise InputError(f"equation {waiting[0]} is not yet judged: no derivation states it")
    shown = [verdict for verdict in verdicts if not given.ids or verdict.id in given.ids]
    if given.json:
        print(audit.to_json(shown))
    else:
        rows = []
        for v in shown:
            rows.append((v.id, word(v.verdict), ": ".join(filter(None, (equation(v.id).title, note(v))))))
            if v.verdict in ("refuted", "measured") and v.statement.correction:
                rows.append(("", "", f"right: {in_a_line(v.statement)}"))
        print(table(("id", "verdict", "equation: order or condition"), rows))
    on_record = recorded()
    return _compared(changes(outcomes(shown), on_record, given.ids or equations()), on_record)


def in_a_line(statement: "Statement") -> str:
    """The correction of an equation as plain text, or where it stands when that is too long to read in a terminal."""
    told = "; ".join(
        str(r.printed) + (f" + O({r.small ** (r.claimed + 1)})" if r.small else "") for r in statement.correction
    )
    return told if len(told) <= _LONGEST else "see the errata sheet (lagrotor reproduce)"


def claims_command(given: argparse.Namespace) -> int:
    from lagrotor.paper import trials
    from lagrotor.paper.catalogue import claims
    from lagrotor.report.content import word
    from lagrotor.report.reproduce import changes, outcomes, recorded

    if unknown := [i for i in given.ids if i not in claims()]:
        raise InputError(f"claim {unknown[0]!r} is not in the catalogue: ids run from C01 to C{len(claims()):02d}")
    wanted = frozenset(given.ids or claims())
    with progress(len(wanted)) as step:
        results = trials.hear_all(step, wanted)
    if given.json:
        print(trials.to_json(results))
    else:
        for result in results:
            identifier, finding = result.trial.id, result.finding
            print(wrapped(f"{identifier}  {claims()[identifier].text}", 5))
            print(wrapped(f"     {word(finding.outcome)}: {finding.explanation}", 5), end="\n\n")
    on_record = recorded()
    return _compared(changes(outcomes(heard=results), on_record, wanted), on_record)


def _compared(changes: list[str], on_record: dict[str, str] | None) -> int:
    if on_record is None:
        return say("no verdicts are on record yet: nothing to compare these with", 0)
    for change in changes:
        say(f"changed: {change}", 1)
    return 1 if changes else 0
