"""The whole audit in as many processes as there are cores: the verdicts are those of `Paper.audit`."""

from functools import partial
from typing import Any

from lagrotor.paper.audit import Audit
from lagrotor.paper.papers import Paper, Progress
from lagrotor.paper.verdicts import Verdict
from lagrotor.report.job.processes import JUDGING, cores, results, values
from lagrotor.report.job.reach import scripts_named, values_taken

_FEW = 8  # scripts that are judged before other processes would have begun


def audit_in_processes(paper: Paper, progress: Progress, jobs: int | None = None) -> Audit:
    """Judge every equation; jobs: how many processes, None: as many as there are cores, one for few scripts.

    `progress` is called with the name of each script before it runs. Raises what `Paper.audit` raises.
    """
    stems = paper.stating_scripts
    jobs = (1 if len(stems) < _FEW else cores()) if jobs is None else jobs
    if jobs == 1:
        return paper.audit(progress=progress)
    paper.check_scripts()
    needs = {stem: set(scripts_named(paper.scripts.path("derivations", stem), paper)) & set(stems) for stem in stems}
    judgements: dict[str, tuple[list[Verdict], dict[str, Any]]] = {}

    def given(stem: str) -> tuple[dict[str, dict[str, Any]]] | None:
        return (
            ({needed: judgements[needed][1] for needed in needs[stem]},) if needs[stem] <= judgements.keys() else None
        )

    for stem, product in results(stems, partial(_judge_script, paper), jobs, progress, given, JUDGING):
        judgements[stem] = product
    return paper.audit_of(verdict for stem in stems for verdict in judgements[stem][0])


def _judge_script(paper: Paper, stem: str, given: dict[str, dict[str, Any]]) -> tuple[list[Verdict], dict[str, Any]]:
    """The verdicts on what one script states, and the values that others take from it."""
    with paper.scripts.ran_elsewhere(given):
        verdicts = paper.judged(stem)
        return verdicts, values(paper.scripts.executed("derivations", stem).names, values_taken(stem, paper))
