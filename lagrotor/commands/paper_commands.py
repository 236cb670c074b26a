"""The commands about a paper: judge, init, notation, readings, derive, check, reproduce, audit, certify, claims, figure.

Exit status 1 when a verdict is not as recorded, or a check finds something wrong.

Without --paper they are about the paper that lagrotor was written for.
"""

import argparse
import time
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from lagrotor.commands.terminal import Command, add_json, check_folder, print_json, progress, say, table, wrap
from lagrotor.errors import InputError

if TYPE_CHECKING:
    from lagrotor.paper.papers import Paper


def add_paper_commands(command: Command) -> None:
    """Add the commands that read equations and those that test a paper."""
    _add_reading_commands(command)
    _add_testing_commands(command)


def _add_reading_commands(command: Command) -> None:
    """judge, init, notation, readings, derive, check."""
    added = command("judge", judge_command, "judge one equation", 'lagrotor judge "sqrt(x**2) = x" --given "x >= 0"')
    added.description = (
        "Judge one equation, written as in Python or in LaTeX: whether it holds, where, under which premises; the proof\n"
        "is exact, and what is refuted has a point at which the two sides differ.\n"
        "Exit status: 0 it holds, perhaps to an order or under premises, 1 it does not or is undecided, 2 bad usage or input."
    )
    added.add_argument("equation", metavar="EQUATION", help="left = right; letters are real")
    added.add_argument("--given", nargs="+", default=[], metavar="RELATION", help="premises: J = I_3, x >= 0, a != b")
    add_json(added)

    added = command("init", init_command, "begin a paper of your own", "lagrotor init my-paper --from paper.tex")
    added.description = (
        "Begin a paper of your own: a folder with one worked equation, claim and figure, or with the equations of a source.\n"
        "Again with --from: the source has changed; what is confirmed or derived stays."
    )
    added.add_argument("folder", type=Path, metavar="DIR", help="a new or an empty folder, or the one to make again")
    source = "take the displayed equations of a .tex file, and read them"
    added.add_argument("--from", type=Path, metavar="FILE", dest="source", help=source)

    added = command(
        "notation", notation_command, "declare the kinds of letters", "lagrotor notation my-paper --confirm f r"
    )
    added.description = (
        "Show the letters that are declared or proposed as functions, vectors, matrices, indices or numbers, each with a\n"
        "formula where this is seen. Every other letter is a real number."
    )
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder")
    added.add_argument("--confirm", nargs="+", default=[], metavar="LETTER", help="declare these as proposed")
    added.add_argument("--real", nargs="+", default=[], metavar="LETTER", help="declare these as real numbers")
    add_json(added, "a JSON list, one object a letter")

    added = command(
        "readings", readings_command, "compare readings with the print", "lagrotor readings my-paper --confirm 3 5a"
    )
    added.description = "How each equation was read, beside its print; what you confirm can be judged."
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder")
    added.add_argument("--confirm", nargs="+", metavar="ID", help="these readings are what is printed")
    add_json(added, "a JSON list, one object an equation")

    added = command("derive", derive_command, "derive what paper.toml states", "lagrotor derive my-paper")
    added.description = (
        "Write the derivation of the system that paper.toml states: coordinates, L, constraints; no Python is needed."
    )
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder, with [system] in its paper.toml")

    added = command("check", check_command, "check a source by itself", "lagrotor check paper.tex --json")
    added.description = (
        "Check a source without any derivation: each step of a chain, claimed orders, indices.\n"
        "Exit status: 0 nothing was found, 1 something was, 2 bad usage or input."
    )
    added.add_argument("sources", nargs="+", type=Path, metavar="FILE", help="a .tex file")
    add_json(added, "a JSON object: findings, steps, reasons")
    added.add_argument("--all", action="store_true", help="show the steps that hold and those that are not judged, too")


def _add_testing_commands(command: Command) -> None:
    """reproduce, audit, certify, claims, figure."""
    added = command(
        "reproduce",
        reproduce_command,
        "judge every equation, draw every figure, write the report",
        "lagrotor reproduce --out report",
    )
    _add_paper(added)
    added.add_argument("--out", type=Path, default=Path("report"), metavar="DIR", help="folder (default: report)")
    added.add_argument("--jobs", type=int, metavar="N", help="processes (default: one a core, one in a debugger)")
    proofs = "write the proof of each exact verdict into DIR/certificates, linked from the page; lagrotor certify checks them"
    added.add_argument("--certify", action="store_true", help=proofs)
    add_json(added, "what was found as a JSON object")

    added = command("audit", audit_command, "judge the paper's equations", "lagrotor audit 5.12 5.15 --json")
    added.description = "Judge the paper's equations. For single ids only their own derivations run."
    added.add_argument("ids", nargs="*", metavar="ID", help="equations, such as 5.15 (default: all that are judged)")
    _add_paper(added)
    add_json(added, "a JSON list, one object an equation")
    added.add_argument("--record", action="store_true", help="put the verdicts on record, once they have been read")
    proofs = "write each exact verdict with its proof as a file of Coq into this folder; lagrotor certify checks them"
    added.add_argument("--certify", type=Path, metavar="DIR", help=proofs)

    added = command("certify", certify_command, "check certificates with Coq", "lagrotor certify certificates")
    added.description = (
        "Check the certificates that lagrotor audit --certify wrote. It needs coqc and its Interval library."
    )
    added.epilog = "exit status: 0 all accepted, 1 one is rejected, 2 nothing could be checked\n" + str(added.epilog)
    added.add_argument("folder", type=Path, metavar="DIR", help="the folder of certificates")
    add_json(added, "a JSON list, one object a line")

    added = command("claims", claims_command, "test the paper's claims", "lagrotor claims C08 C22 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="claims, such as C08 (default: all)")
    _add_paper(added)
    add_json(added, "a JSON list, one object a claim")
    added.add_argument("--record", action="store_true", help="put the outcomes on record, once they have been read")

    added = command("figure", figure_command, "draw figures as SVG and PNG", "lagrotor figure 17 t6 --out .")
    added.add_argument("keys", nargs="+", metavar="N", help="a figure's number, or letter and number, such as t6")
    _add_paper(added)
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")
    add_json(added, "a JSON list: files and measured numbers of each")


def _add_paper(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--paper", type=Path, metavar="DIR", help="a paper's folder (default: the rotor pair's)")


def _paper(given: argparse.Namespace) -> "Paper":
    if given.paper is None:
        from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

        return PAPER
    from lagrotor.paper.papers import opened

    return opened(given.paper.resolve())


def judge_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.audit import line_data
    from lagrotor.paper.judgement import judge_text
    from lagrotor.paper.verdicts import AGREES

    said = judge_text(given.equation, given.given)
    if given.json:
        lines = [line_data(line) for line in said.verdict.lines]
        data = {"read": said.readings, "verdict": said.verdict.verdict, "lines": lines}
        print_json(data)
    else:
        print("\n".join(wrap(line, 4) for line in repr(said).splitlines()))
    return 0 if said.verdict.verdict in AGREES else 1


def init_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.latex.init import begin_paper

    made = begin_paper(given.folder, given.source)
    equations = _some(made.equations, "equation")
    print(f"{made.folder}: {equations}; {made.read} read" if given.source else f"{made.folder}: {equations}")
    for note in made.notes:
        print(f"  {note}")
    if made.changed:
        print(f"changed since, to be confirmed again: {', '.join(made.changed)}")
    if made.gone:
        print(f"no longer in the source: {', '.join(made.gone)}")
    if given.source:
        print(f"see the kinds of its letters: lagrotor notation {made.folder}")
        print(f"compare the readings with the print: lagrotor readings {made.folder}")
    print(f"go on with {made.folder / 'README.md'}, and with: lagrotor audit --paper {made.folder}")
    return 0


def notation_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.init import declare
    from lagrotor.paper.latex.readings import letter_kinds

    rows = letter_kinds(Catalogue(given.folder))
    proposals = {each.letter: each.kind for each in rows if not each.declared}
    if unknown := [letter for letter in given.confirm if letter not in proposals]:
        raise InputError(
            f"notation: nothing is proposed for {unknown[0]}: the proposals are for {', '.join(proposals) or 'no letter'}"
        )
    if given.confirm or given.real:
        declare(
            given.folder, {letter: proposals[letter] for letter in given.confirm} | dict.fromkeys(given.real, "real")
        )
        rows = letter_kinds(Catalogue(given.folder))
    if given.json:
        print_json([asdict(each) for each in rows])
        return 0
    shown = [(each.letter, each.kind, "declared" if each.declared else "proposed", each.evidence) for each in rows]
    print(table(("letter", "kind", "", "seen in"), shown) if rows else "every letter is a real number")
    if any(not each.declared for each in rows):
        say(f"declare a proposal: lagrotor notation {given.folder} --confirm LETTER …, or --real LETTER …", 0)
    return 0


def readings_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.init import confirm
    from lagrotor.paper.latex.readings import readings
    from lagrotor.paper.plain_text import from_latex, readable

    paper = Catalogue(given.folder)
    if given.confirm:
        done = confirm(paper.folder, given.confirm)
        return say(f"confirmed: {', '.join(done)}", 0)
    found = list(readings(paper))
    if given.json:
        print_json([asdict(each) for each in found])
        return 0
    for each in found:
        moved = f", printed ({each.number})" if each.number else ""
        print(wrap(f"{each.id}{moved}  {each.title}: {each.status}", 4))
        print(wrap(f"    print    {each.print}", 13))
        for text in each.said:
            shown = " = ".join(from_latex(side) if "\\" in side else readable(side) for side in text.split(" = "))
            print(wrap(f"    read     {shown}", 13))
        if each.stopped:
            print(wrap(f"    stopped  {each.stopped}: {each.helps}", 13))
    counts = Counter(each.status for each in found)
    say(f"{_some(len(found), 'equation')}: {', '.join(f'{n} {status}' for status, n in counts.items())}", 0)
    if counts["unconfirmed"] or counts["changed"]:
        say(f"confirm what is read as printed: lagrotor readings {given.folder} --confirm ID …", 0)
    return 0


def derive_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.stated_system import write_derivation

    made, refused = write_derivation(Catalogue(given.folder))
    for identifier, why in refused.items():
        say(f"equation {identifier} is left out: {why}", 0)
    print(f"{made}; judge it with: lagrotor audit --paper {given.folder}")
    return int(bool(refused))


def check_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import toml
    from lagrotor.paper.latex.check import FAULT, WRONG, Check, check_source
    from lagrotor.paper.latex.displays import read_source
    from lagrotor.paper.latex.notation import Notation, declared_notation
    from lagrotor.paper.plain_text import readable

    rows, displayed = [], 0
    for file in given.sources:
        source = read_source(file)
        displayed += len(source.equations)
        for note in source.notes or ([] if source.equations else ["it has no displayed equation"]):
            say(f"{file}: {note}", 0)
        about = Path(file).parent / "paper.toml"
        notation = declared_notation(toml(about).get("notation", {}), str(about)) if about.is_file() else Notation()
        check = check_source(source, notation)
        rows += [(file.parent / each.file if each.file else file, each) for each in check.findings]
    whole = Check(tuple(each for _, each in rows))
    if given.json:
        several = len(given.sources) > 1
        shown = [(file, each) for file, each in rows if given.all or each.verdict in WRONG]
        found = [each.as_data() | ({"file": str(file)} if several or each.file else {}) for file, each in shown]
        data = {"findings": found, "steps": whole.counts, "reasons": whole.reasons}
        print_json(data)
    else:
        for file, each in rows:
            if given.all or each.verdict in WRONG:
                step = f", step {each.step}" if each.step else ""
                of = "" if each.verdict == FAULT else f"({each.equation}){step}: {each.verdict}: "
                print(wrap(f"{file}:{each.line}: {of}{readable(each.why) if of else each.why}", 4))
                if each.members:
                    print(wrap("    {} = {}".format(*map(readable, each.members)), 6))
        counts = "; ".join(f"{verdict}: {count}" for verdict, count in whole.counts.items())
        say(f"{_some(displayed, 'displayed equation')}; steps: {counts}", 0)
        if whole.reasons:
            reasons = "; ".join(f"{reason} ({count})" for reason, count in whole.reasons.items())
            say(f"not judged because {reasons}{'' if given.all else '; all of them: --all'}", 0)
    return 1 if any(each.verdict in WRONG for _, each in rows) else 0


def _some(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def reproduce_command(given: argparse.Namespace) -> int:
    if given.jobs is not None and given.jobs < 1:
        raise InputError(f"--jobs {given.jobs} must be at least 1: it is how many processes run")
    from lagrotor.report.content import count_list
    from lagrotor.report.formulas.mathml_latex import converter
    from lagrotor.report.job.reproduce import reproduce

    paper = _paper(given)
    made = reproduce(paper, given.out, progress, given.jobs, given.certify)
    page = given.out / "index.html"
    if given.json:
        print_json(asdict(made) | {"report": str(page)})
        return _say_changes(made.changes, bool(paper.recorded))
    print(f"{_some(sum(made.equations.values()), 'equation')}: {count_list(made.equations) or 'none'}")
    if made.claims:
        print(f"{_some(sum(made.claims.values()), 'claim')} tested: {count_list(made.claims)}")
    if made.taken == ["report"]:
        print("all taken from the last run (same inputs); to write it again, delete the folder")
    elif made.taken:
        kinds = Counter(name.split()[0] for name in made.taken)
        parts = ", ".join(_some(count, kind) for kind, count in kinds.items())
        print(f"{parts} taken from earlier runs (same inputs)")
    print(f"{_some(made.figures, 'figure')}; {made.seconds:.1f} s; report: {page}")
    if not converter():
        print("the page shows printed equations as LaTeX source; to see them typeset: pip install 'lagrotor[report]'")
    return _say_changes(made.changes, bool(paper.recorded))


def audit_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.audit import NOT_YET, in_words, verdicts_json
    from lagrotor.paper.catalogue import known_id
    from lagrotor.paper.plain_text import readable
    from lagrotor.report.content import count_list, word
    from lagrotor.report.facts import note

    paper = _paper(given)
    identifiers = [known_id(identifier, paper.equations) for identifier in given.ids]
    with progress(len(identifiers) or len(paper.stating_scripts)) as step:
        found = None
        if not identifiers:
            from lagrotor.report.job.steps import audit_in_processes

            found = audit_in_processes(paper, step)
        shown = [paper.audit(i, step) for i in identifiers] if found is None else list(found)
    waiting = found.waiting if found is not None else ()
    if given.json:
        print(verdicts_json(shown, paper, waiting))
    elif identifiers:
        words = "\n\n".join(in_words(verdict, paper) for verdict in shown)
        print("\n".join(wrap(line, 13) for line in words.split("\n")))
    else:
        titles = {i: entry.title for i, entry in paper.equations.items()}
        rows = [(v.id, word(v.verdict), readable(": ".join(filter(None, (titles[v.id], note(v)))))) for v in shown]
        rows += [(i, word(NOT_YET), titles[i]) for i in waiting]
        print(table(("id", "verdict", "equation: order, premises"), rows))
        if found is not None and waiting:
            say(f"{len(found.ids)} equations: {count_list(found.counts)}", 0)
    if given.certify is not None:
        from lagrotor.proofs.coq.coq_check import certify

        files = sum(bool(row.file) for row in certify(shown, paper, given.certify))
        say(f"{_some(files, 'certificate')} in {given.certify}; to check: lagrotor certify {given.certify}", 0)
    if given.record:
        return say(f"put on record in {paper.renew_record(shown)}", 0)
    changes = paper.changes(shown, identifiers or paper.equations)
    return _say_changes(changes, bool(paper.recorded))


def certify_command(given: argparse.Namespace) -> int:
    from lagrotor.paper.plain_text import from_latex
    from lagrotor.proofs.coq.coq_check import check_certificates, read_certificates
    from lagrotor.report.content import word

    began = time.perf_counter()
    with progress(len(read_certificates(given.folder))) as step:
        found = check_certificates(given.folder, step)
    counts = Counter(each.status for each in found)
    if given.json:
        rows = [
            {"id": c.id, "line": c.line.name, "verdict": c.line.verdict, "checked": c.status, "why": c.why}
            for c in found
        ]
        print_json(rows)
    else:
        shown = [
            (
                c.id,
                c.line.name,
                word(c.line.verdict),
                ": ".join(filter(None, (c.status, c.why))),
                from_latex(c.line.quantity),
            )
            for c in found
        ]
        print(table(("id", "line", "verdict", "Coq", "quantity"), shown))
    summary = ", ".join(f"{counts[status]} {status}" for status in ("accepted", "rejected", "skipped"))
    return say(
        f"{_some(len(found), 'line')}: {summary}; {time.perf_counter() - began:.0f} s", min(counts["rejected"], 1)
    )


def claims_command(given: argparse.Namespace) -> int:
    from lagrotor.paper import claim_tests
    from lagrotor.paper.catalogue import known_id
    from lagrotor.paper.plain_text import readable
    from lagrotor.report.content import word

    paper = _paper(given)
    if not paper.claims:
        return say(f"{paper.title} has no claims.toml: there is nothing to test", 0)
    wanted = frozenset(known_id(identifier, paper.claims) for identifier in given.ids) or frozenset(paper.claims)
    with progress(len(wanted)) as step:
        results = paper.evaluate(step, wanted)
    if given.json:
        print(claim_tests.claims_json(results, paper.claims))
    else:
        for result in results:
            identifier, finding = result.test.id, result.finding
            print(wrap(f"{identifier}  {readable(paper.claims[identifier].text)}", 5))
            print(wrap(f"     {word(finding.outcome)}: {readable(finding.explanation)}", 5))
            for part, theorem in finding.theorems:
                print(wrap(f"     {readable(part.says)}: {part.outcome}: {theorem.text}", 5))
            print()
    if untested := sorted(wanted - {result.test.id for result in results}):
        say(f"not yet tested: {', '.join(untested)}", 0)
    if given.record:
        return say(f"put on record in {paper.renew_record(results)}", 0)
    changes = paper.changes(results, [i for i in paper.claims if i in wanted])
    return _say_changes(changes, bool(paper.recorded))


def figure_command(given: argparse.Namespace) -> int:
    from lagrotor.pictures.figures import check_keys, draw_figure

    check_folder(given.out)
    scripts = _paper(given).scripts
    keys, drawn = check_keys(given.keys, scripts), []
    with progress(len(keys)) as step:
        for key in keys:
            step(f"figure {key}")
            drawn.append(draw_figure(key, given.out, scripts))
            if not given.json:
                print(drawn[-1].svg, drawn[-1].png, sep="\n")
    if given.json:
        found = (
            {"key": p.key, "title": p.title, "svg": str(p.svg), "png": str(p.png), "measured": p.measured}
            for p in drawn
        )
        print_json(list(found))
    return 0


def _say_changes(changes: list[str], on_record: bool) -> int:
    if not on_record:
        return say("no verdicts are on record yet: nothing to compare these with", 0)
    for change in changes:
        say(f"changed: {change}", 1)
    return 1 if changes else 0
