"""The commands about a paper: pair, judge, init, notation, readings, derive, check, reproduce, audit, certify, claims, figure.

The exit status is 1 if a verdict differs from the recorded one, or if an error is found. Without --paper, a command uses
the paper on the rotor pair.
"""

import argparse
import time
from collections import Counter
from contextlib import nullcontext
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from lagrotor.commands.scene_commands import add_scene, scene_from_options
from lagrotor.commands.terminal import Command, add_json, check_folder, print_json, progress, say, table, wrap
from lagrotor.errors import InputError

if TYPE_CHECKING:
    from lagrotor.paper.papers import Paper


def add_paper_commands(command: Command) -> None:
    _add_reading_commands(command)
    _add_testing_commands(command)


def _add_reading_commands(command: Command) -> None:
    """Add the commands that read a paper: judge, init, notation, readings, derive and check."""
    example = "lagrotor pair --paired 0.3 --link-length 1.5 --link-mass 1"
    added = command("pair", pair_command, "print the pair's formulas, and compare them with a run", example)
    added.description = (
        "Print the Lagrangian of the pair, the bar's constraint, A and B, the precession rate and the corrected trajectories,\n"
        "and compare the rate and the trajectories with an integrated paired precession. Without options it is the paper's:\n"
        "spins of ±10 rad/s, a massless bar, ell = R = 1 m, amplitude 0.204."
    )
    says = "amplitude: the sine of the inclination when the axes are parallel (default: 0.204)"
    added.add_argument("--paired", type=float, default=0.204, metavar="R0", help=says)
    add_scene(added)
    add_json(added, "a JSON object: LaTeX of each formula, and the differences")

    added = command(
        "judge", judge_command, "decide whether one equation holds", 'lagrotor judge "sqrt(x**2) = x" --given "x >= 0"'
    )
    added.description = (
        "Decide exactly whether an equation, in Python or LaTeX notation, holds, in which domain and under which premises.\n"
        "A refuted equation comes with a point at which its sides differ.\n"
        "Exit status: 0 it holds, perhaps to an order or under premises, 1 it does not or is undecided, 2 bad usage or input."
    )
    added.add_argument("equation", metavar="EQUATION", help="left = right; symbols are real")
    added.add_argument("--given", nargs="+", default=[], metavar="RELATION", help="premises: J = I_3, x >= 0, a != b")
    add_json(added)

    added = command("init", init_command, "make the folder of a new paper", "lagrotor init my-paper --from paper.tex")
    added.description = (
        "Make the folder of a new paper, with one worked equation, claim and figure, or with the equations of a source.\n"
        "Run it again with --from after the source has changed: confirmed and derived equations stay."
    )
    added.add_argument("folder", type=Path, metavar="DIR", help="a new or empty folder, or a paper to update")
    source = "read the displayed equations of a .tex file"
    added.add_argument("--from", type=Path, metavar="FILE", dest="source", help=source)

    added = command(
        "notation", notation_command, "declare the kinds of symbols", "lagrotor notation my-paper --confirm f r"
    )
    added.description = (
        "Show the symbols that are declared or proposed as functions, vectors, matrices, indices or numbers, each proposal\n"
        "with a formula that suggests it. Every other symbol is a real number."
    )
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder")
    added.add_argument("--confirm", nargs="+", default=[], metavar="SYMBOL", help="declare these as proposed")
    added.add_argument("--real", nargs="+", default=[], metavar="SYMBOL", help="declare these as real numbers")
    add_json(added, "a JSON list, one object per symbol")

    added = command(
        "readings", readings_command, "compare readings with the source", "lagrotor readings my-paper --confirm 3 5a"
    )
    added.description = "Show each printed equation and its reading. Only a confirmed reading can be judged."
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder")
    added.add_argument("--confirm", nargs="+", metavar="ID", help="confirm these readings as correct")
    add_json(added, "a JSON list, one object per equation")

    added = command("derive", derive_command, "derive the system in paper.toml", "lagrotor derive my-paper")
    added.description = "Write the derivation of the system in paper.toml (coordinates, L, constraints) without Python."
    added.add_argument("folder", type=Path, metavar="DIR", help="a paper's folder, with [system] in its paper.toml")

    added = command("check", check_command, "check a source without derivations", "lagrotor check paper.tex --json")
    added.description = (
        "Check each step of a chain of equations, claimed orders and indices.\n"
        "Exit status: 0 no error was found, 1 an error was found, 2 bad usage or input."
    )
    added.add_argument("sources", nargs="+", type=Path, metavar="FILE", help="a .tex file")
    add_json(added, "a JSON object: findings, steps, reasons")
    added.add_argument("--all", action="store_true", help="also show steps that hold or are not judged")


def _add_testing_commands(command: Command) -> None:
    """Add the commands that test a paper: reproduce, audit, certify, claims and figure."""
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
    add_json(added, "the results as a JSON object")

    added = command("audit", audit_command, "judge the paper's equations", "lagrotor audit 5.12 5.15 --json")
    added.description = "Judge the paper's equations. With ids, only the derivations of these equations run."
    added.add_argument("ids", nargs="*", metavar="ID", help="equations, such as 5.15 (default: all that are judged)")
    _add_paper(added)
    add_json(added, "a JSON list, one object per equation")
    added.add_argument("--record", action="store_true", help="record the verdicts; read them first")
    proofs = "write each exact verdict with its proof as a file of Coq into this folder; lagrotor certify checks them"
    added.add_argument("--certify", type=Path, metavar="DIR", help=proofs)

    added = command("certify", certify_command, "check certificates with Coq", "lagrotor certify certificates")
    added.description = (
        "Check the certificates that lagrotor audit --certify wrote. It needs coqc and its Interval library."
    )
    added.epilog = "exit status: 0 all accepted, 1 one is rejected, 2 nothing could be checked\n" + str(added.epilog)
    added.add_argument("folder", type=Path, metavar="DIR", help="the folder of certificates")
    add_json(added, "a JSON list, one object per line")

    added = command("claims", claims_command, "test the paper's claims", "lagrotor claims C08 C22 --json")
    added.add_argument("ids", nargs="*", metavar="ID", help="claims, such as C08 (default: all)")
    _add_paper(added)
    add_json(added, "a JSON list, one object per claim")
    added.add_argument("--record", action="store_true", help="record the outcomes; read them first")

    added = command("figure", figure_command, "draw figures as SVG and PNG", "lagrotor figure 17 t6 --out .")
    added.add_argument("keys", nargs="+", metavar="N", help="a figure's number, or letter and number, such as t6")
    _add_paper(added)
    added.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="existing folder (default: this one)")
    add_json(added, "a JSON list of files and measured numbers")


def _add_paper(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--paper", type=Path, metavar="DIR", help="a paper's folder (default: the rotor pair's)")


def _paper(options: argparse.Namespace) -> "Paper":
    if options.paper is None:
        from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

        return PAPER
    from lagrotor.paper.papers import opened

    return opened(options.paper.resolve())


def pair_command(options: argparse.Namespace) -> int:
    from lagrotor.mechanics.glossary import latex
    from lagrotor.paper.rotor_pair.pair_page import compare_pair, pair_formulas, pair_page

    if options.scene is None and options.spins is None:
        options.spins = (10.0, -10.0)
    comparison = compare_pair(options.paired, scene_from_options(options))
    if options.json:
        numbers = {name: value for name, value in vars(comparison).items() if name != "run"}
        formulas = {name: latex(expression) for name, expression in pair_formulas().items()}
        print_json({"formulas": formulas, "comparison": numbers | {"error": comparison.run.error}})
        return 0
    for heading, lines in pair_page(comparison):
        print(wrap(heading, 4), *(f"    {wrap(line, 8)}" for line in lines), "", sep="\n")
    return 0


def judge_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.audit import line_data
    from lagrotor.paper.judgement import judge_text
    from lagrotor.paper.verdicts import AGREES

    judgement = judge_text(options.equation, options.given)
    if options.json:
        lines = [line_data(line) for line in judgement.verdict.lines]
        data = {"read": judgement.readings, "verdict": judgement.verdict.verdict, "lines": lines}
        print_json(data)
    else:
        print("\n".join(wrap(line, 4) for line in repr(judgement).splitlines()))
    return 0 if judgement.verdict.verdict in AGREES else 1


def init_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.latex.init import begin_paper

    paper = begin_paper(options.folder, options.source)
    equations = _plural(paper.equations, "equation")
    print(f"{paper.folder}: {equations}; {paper.read} read" if options.source else f"{paper.folder}: {equations}")
    for note in paper.notes:
        print(f"  {note}")
    if paper.changed:
        print(f"the LaTeX has changed, confirm the reading again: {', '.join(paper.changed)}")
    if paper.gone:
        print(f"no longer in the source: {', '.join(paper.gone)}")
    if options.source:
        print(f"see the kinds of its symbols: lagrotor notation {paper.folder}")
        print(f"compare the readings with the printed equations: lagrotor readings {paper.folder}")
    print(f"continue with {paper.folder / 'README.md'}, and with: lagrotor audit --paper {paper.folder}")
    return 0


def notation_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.init import declare
    from lagrotor.paper.latex.readings import symbol_kinds

    rows = symbol_kinds(Catalogue(options.folder))
    proposals = {row.symbol: row.kind for row in rows if not row.declared}
    if unknown := [name for name in options.confirm if name not in proposals]:
        raise InputError(
            f"notation: nothing is proposed for {unknown[0]}: there are proposals for {', '.join(proposals) or 'no symbol'}"
        )
    if options.confirm or options.real:
        kinds = {name: proposals[name] for name in options.confirm} | dict.fromkeys(options.real, "real")
        declare(options.folder, kinds)
        rows = symbol_kinds(Catalogue(options.folder))
    if options.json:
        print_json([asdict(row) for row in rows])
        return 0
    cells = [(row.symbol, row.kind, "declared" if row.declared else "proposed", row.evidence) for row in rows]
    print(table(("symbol", "kind", "", "formula"), cells) if rows else "every symbol is a real number")
    if any(not row.declared for row in rows):
        say(f"declare a proposal: lagrotor notation {options.folder} --confirm SYMBOL …, or --real SYMBOL …", 0)
    return 0


def readings_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.init import confirm
    from lagrotor.paper.latex.readings import readings
    from lagrotor.paper.plain_text import from_latex, readable

    paper = Catalogue(options.folder)
    if options.confirm:
        confirmed = confirm(paper.folder, options.confirm)
        return say(f"confirmed: {', '.join(confirmed)}", 0)
    rows = list(readings(paper))
    if options.json:
        print_json([asdict(reading) for reading in rows])
        return 0
    for reading in rows:
        number = f", printed ({reading.number})" if reading.number else ""
        print(wrap(f"{reading.id}{number}  {reading.title}: {reading.status}", 4))
        print(wrap(f"    printed  {reading.print}", 13))
        for text in reading.lines:
            formula = " = ".join(from_latex(side) if "\\" in side else readable(side) for side in text.split(" = "))
            print(wrap(f"    read     {formula}", 13))
        if reading.stopped:
            print(wrap(f"    stopped  {reading.stopped}: {reading.helps}", 13))
    counts = Counter(reading.status for reading in rows)
    say(f"{_plural(len(rows), 'equation')}: {', '.join(f'{n} {status}' for status, n in counts.items())}", 0)
    if counts["unconfirmed"] or counts["changed"]:
        say(f"confirm the correct readings: lagrotor readings {options.folder} --confirm ID …", 0)
    return 0


def derive_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import Catalogue
    from lagrotor.paper.latex.stated_system import write_derivation

    script, refused = write_derivation(Catalogue(options.folder))
    for identifier, why in refused.items():
        say(f"equation {identifier} is left out: {why}", 0)
    print(f"{script}; judge it with: lagrotor audit --paper {options.folder}")
    return int(bool(refused))


def check_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.catalogue import toml
    from lagrotor.paper.latex.check import FAULT, WRONG, Check, check_source
    from lagrotor.paper.latex.displays import read_source
    from lagrotor.paper.latex.notation import Notation, declared_notation
    from lagrotor.paper.plain_text import readable

    rows, displayed = [], 0
    for file in options.sources:
        source = read_source(file)
        displayed += len(source.equations)
        for note in source.notes or ([] if source.equations else ["it has no displayed equation"]):
            say(f"{file}: {note}", 0)
        about = Path(file).parent / "paper.toml"
        notation = declared_notation(toml(about).get("notation", {}), str(about)) if about.is_file() else Notation()
        check = check_source(source, notation)
        rows += [(file.parent / finding.file if finding.file else file, finding) for finding in check.findings]
    whole = Check(tuple(finding for _, finding in rows))
    if options.json:
        several = len(options.sources) > 1
        selected = [(file, finding) for file, finding in rows if options.all or finding.verdict in WRONG]
        findings = [
            finding.as_data() | ({"file": str(file)} if several or finding.file else {}) for file, finding in selected
        ]
        data = {"findings": findings, "steps": whole.counts, "reasons": whole.reasons}
        print_json(data)
    else:
        for file, finding in rows:
            if options.all or finding.verdict in WRONG:
                step = f", step {finding.step}" if finding.step else ""
                of = "" if finding.verdict == FAULT else f"({finding.equation}){step}: {finding.verdict}: "
                print(wrap(f"{file}:{finding.line}: {of}{readable(finding.why) if of else finding.why}", 4))
                if finding.members:
                    print(wrap("    {} = {}".format(*map(readable, finding.members)), 6))
        counts = "; ".join(f"{verdict}: {count}" for verdict, count in whole.counts.items())
        say(f"{_plural(displayed, 'displayed equation')}; steps: {counts}", 0)
        if whole.reasons:
            reasons = "; ".join(f"{reason} ({count})" for reason, count in whole.reasons.items())
            say(f"not judged because {reasons}{'' if options.all else '; --all lists these steps'}", 0)
    return 1 if any(finding.verdict in WRONG for _, finding in rows) else 0


def _plural(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def reproduce_command(options: argparse.Namespace) -> int:
    if options.jobs is not None and options.jobs < 1:
        raise InputError(f"--jobs {options.jobs} must be at least 1: it is the number of processes")
    from lagrotor.report.job.processes import cores, ending_at_interrupt, server

    with server() if (options.jobs or cores()) > 1 else nullcontext():
        with ending_at_interrupt():
            from lagrotor.report.content import count_list
            from lagrotor.report.formulas.mathml_latex import converter
            from lagrotor.report.job.reproduce import reproduce

            paper = _paper(options)
        result = reproduce(paper, options.out, progress, options.jobs, options.certify)
    page = options.out / "index.html"
    if options.json:
        print_json(asdict(result) | {"report": str(page)})
        return _say_changes(result.changes, bool(paper.recorded))
    print(f"{_plural(sum(result.equations.values()), 'equation')}: {count_list(result.equations) or 'none'}")
    if result.claims:
        print(f"{_plural(sum(result.claims.values()), 'claim')} tested: {count_list(result.claims)}")
    if result.reused == ["report"]:
        print("all taken from the last run (same inputs); to compute it again, delete the folder")
    elif result.reused:
        kinds = Counter(name.split()[0] for name in result.reused)
        reused = ", ".join(_plural(count, kind) for kind, count in kinds.items())
        print(f"{reused} taken from earlier runs (same inputs)")
    print(f"{_plural(result.figures, 'figure')}; {result.seconds:.1f} s; report: {page}")
    if not converter():
        print("the page shows printed equations as LaTeX source; to see them typeset: pip install 'lagrotor[report]'")
    return _say_changes(result.changes, bool(paper.recorded))


def audit_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.audit import NOT_YET, in_words, verdicts_json
    from lagrotor.paper.catalogue import known_id
    from lagrotor.paper.plain_text import from_latex, readable
    from lagrotor.report.content import count_list, word
    from lagrotor.report.errata import errata, letter_table
    from lagrotor.report.facts import note

    paper = _paper(options)
    identifiers = [known_id(identifier, paper.equations) for identifier in options.ids]
    with progress(len(identifiers) or len(paper.stating_scripts)) as step:
        audit = None
        if not identifiers:
            from lagrotor.report.job.steps import audit_in_processes

            audit = audit_in_processes(paper, step)
        verdicts = [paper.audit(i, step) for i in identifiers] if audit is None else list(audit)
    waiting = audit.waiting if audit is not None else ()
    if options.json:
        print(verdicts_json(verdicts, paper, waiting))
    elif identifiers:
        words = "\n\n".join(in_words(verdict, paper) for verdict in verdicts)
        print("\n".join(wrap(line, 13) for line in words.split("\n")))
        if letters := letter_table(errata(verdicts, paper), paper):
            print("\nletters of the corrections and of the premises")
        for tex, meaning, unit, ids in letters:
            used = f", in {ids}" if len(verdicts) > 1 else ""
            print(wrap(readable(f"  {from_latex(tex)}: {meaning} ({unit}{used})"), 4))
    else:
        titles = {i: entry.title for i, entry in paper.equations.items()}
        rows = [(v.id, word(v.verdict), readable(": ".join(filter(None, (titles[v.id], note(v)))))) for v in verdicts]
        rows += [(i, word(NOT_YET), titles[i]) for i in waiting]
        print(table(("id", "verdict", "equation: order, premises"), rows))
        if audit is not None and waiting:
            say(f"{len(audit.ids)} equations: {count_list(audit.counts)}", 0)
    if options.certify is not None:
        from lagrotor.proofs.coq.coq_check import certify

        files = sum(bool(row.file) for row in certify(verdicts, paper, options.certify))
        say(f"{_plural(files, 'certificate')} in {options.certify}; to check: lagrotor certify {options.certify}", 0)
    if options.record:
        return say(f"recorded in {paper.renew_record(verdicts)}", 0)
    changes = paper.changes(verdicts, identifiers or paper.equations)
    return _say_changes(changes, bool(paper.recorded))


def certify_command(options: argparse.Namespace) -> int:
    from lagrotor.paper.plain_text import from_latex
    from lagrotor.proofs.coq.coq_check import check_certificates, read_certificates
    from lagrotor.report.content import word

    began = time.perf_counter()
    with progress(len(read_certificates(options.folder))) as step:
        checks = check_certificates(options.folder, step)
    counts = Counter(check.status for check in checks)
    if options.json:
        rows = [
            {"id": c.id, "line": c.line.name, "verdict": c.line.verdict, "checked": c.status, "why": c.why}
            for c in checks
        ]
        print_json(rows)
    else:
        cells = [
            (
                c.id,
                c.line.name,
                word(c.line.verdict),
                ": ".join(filter(None, (c.status, c.why))),
                from_latex(c.line.quantity),
            )
            for c in checks
        ]
        print(table(("id", "line", "verdict", "Coq", "quantity"), cells))
    summary = ", ".join(f"{counts[status]} {status}" for status in ("accepted", "rejected", "skipped"))
    return say(
        f"{_plural(len(checks), 'line')}: {summary}; {time.perf_counter() - began:.0f} s", min(counts["rejected"], 1)
    )


def claims_command(options: argparse.Namespace) -> int:
    from lagrotor.paper import claim_tests
    from lagrotor.paper.catalogue import known_id
    from lagrotor.paper.plain_text import readable
    from lagrotor.report.content import word

    paper = _paper(options)
    if not paper.claims:
        return say(f"{paper.title} has no claims.toml, so there are no claims to test", 0)
    identifiers = frozenset(known_id(identifier, paper.claims) for identifier in options.ids) or frozenset(paper.claims)
    with progress(len(identifiers)) as step:
        results = paper.evaluate(step, identifiers)
    if options.json:
        print(claim_tests.claims_json(results, paper.claims))
    else:
        for result in results:
            identifier, finding = result.test.id, result.finding
            print(wrap(f"{identifier}  {readable(paper.claims[identifier].text)}", 5))
            print(wrap(f"     {word(finding.outcome)}: {readable(finding.explanation)}", 5))
            for statement, theorem in finding.theorems:
                print(wrap(f"     {readable(statement.says)}: {statement.outcome}: {theorem.text}", 5))
            print()
    if untested := sorted(identifiers - {result.test.id for result in results}):
        say(f"not yet tested: {', '.join(untested)}", 0)
    if options.record:
        return say(f"recorded in {paper.renew_record(results)}", 0)
    changes = paper.changes(results, [i for i in paper.claims if i in identifiers])
    return _say_changes(changes, bool(paper.recorded))


def figure_command(options: argparse.Namespace) -> int:
    from lagrotor.pictures.figures import check_keys, draw_figure

    check_folder(options.out)
    scripts = _paper(options).scripts
    keys, drawn = check_keys(options.keys, scripts), []
    with progress(len(keys)) as step:
        for key in keys:
            step(f"figure {key}")
            drawn.append(draw_figure(key, options.out, scripts))
            if not options.json:
                print(drawn[-1].svg, drawn[-1].png, sep="\n")
    if options.json:
        rows = (
            {"key": p.key, "title": p.title, "svg": str(p.svg), "png": str(p.png), "measured": p.measured}
            for p in drawn
        )
        print_json(list(rows))
    return 0


def _say_changes(changes: list[str], on_record: bool) -> int:
    if not on_record:
        return say("no verdicts are on record yet: there is nothing to compare with", 0)
    for change in changes:
        say(f"changed: {change}", 1)
    return 1 if changes else 0
