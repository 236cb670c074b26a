"""The processes of the tests begin as those of the command `lagrotor` do, before numpy is imported; which of them runs what;
what hypothesis draws."""

import gc
import os
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from lagrotor.process_settings import begin_process

begin_process()

# Reports that tests make stay out of the user's cache; matplotlib, which lists its fonts there, keeps its place.
_CACHE = tempfile.TemporaryDirectory(prefix="lagrotor-cache-")
os.environ.setdefault("MPLCONFIGDIR", str(Path.home() / ".cache" / "matplotlib"))
os.environ["XDG_CACHE_HOME"] = _CACHE.name

# The same values each time; the slow tests draw others, and keep what fails. `--hypothesis-profile` chooses.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("exploring", deadline=None)

# Files whose tests run the same scripts: one process takes them all and runs each script once.
ONE_PROCESS = (
    ("tests/figures/", "tests/theory/test_derivations", "tests/structures/test_chapter", "tests/derivations/test_b"),
    (
        "tests/derivations/test_s",
        "tests/paper/test_form",
        "tests/paper/test_mutants",
        "tests/paper/test_scripts_do_not",
        "tests/report/formulas/",
        "tests/report/page/",
        "tests/report/test_",
    ),
)
# What takes longest, begun first: a long file that is begun last is waited for by one process alone.
FIRST = (
    "tests/report/job/test_reproduce",
    *ONE_PROCESS[0],
    *ONE_PROCESS[1],
    "tests/paper/",
    "tests/models/",
    "tests/derivations/test_gallery",
)


def exploring(marks: str) -> bool:
    """Whether an expression of marks takes the slow tests."""
    return "slow" in marks.replace("not slow", "")


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("exploring" if exploring(config.option.markexpr) else "repeatable")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """With the slow tests go those that hypothesis draws the values of; the longest files come first."""
    items.sort(key=lambda item: next((i for i, file in enumerate(FIRST) if item.nodeid.startswith(file)), len(FIRST)))
    if exploring(config.option.markexpr):
        for item in items:
            if getattr(getattr(item, "obj", None), "is_hypothesis_test", False):
                item.add_marker("slow")


def pytest_collection_finish() -> None:
    """What was collected stays: it is not searched for garbage again and again."""
    gc.freeze()


@pytest.fixture(scope="session")
def audit() -> Any:
    """Every verdict on the paper, decided once a process."""
    from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER

    return PAPER.audit()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """`--dist=loadfile`, files that run the same scripts as if they were one, in the order of collection."""
    from xdist.scheduler import LoadFileScheduling

    config.option.loadscopereorder = False

    class ByScripts(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return next((files[0] for files in ONE_PROCESS if nodeid.startswith(files)), super()._split_scope(nodeid))

    return ByScripts(config, log) if config.getoption("dist") == "loadfile" else None
