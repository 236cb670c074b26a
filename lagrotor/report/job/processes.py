"""Tasks in parallel processes. Results come in the order of completion; no process remains when the run is stopped."""

import multiprocessing
import os
import pickle
import signal
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

from lagrotor.process_settings import begin_process

Task = TypeVar("Task")
# Imported once, before the processes are forked.
_LOADED = ["lagrotor.report.job.steps", "matplotlib.figure", "scipy.integrate"]
# New objects before a garbage collection. Most objects are expressions in sympy's cache, so frequent collections free little;
# rare ones cost half as much memory again.
_OBJECTS = 2_000_000


def cores() -> int:
    """Return the number of usable processors; 1 under a debugger."""
    if sys.gettrace() is not None or "pydevd" in sys.modules:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def results(
    tasks: Iterable[Task],
    run: Callable[..., Any],
    jobs: int,
    begins: Callable[[Task], None],
    inputs: Callable[[Task], Any] = lambda task: (),
) -> Iterator[tuple[Task, Any]]:
    """Run tasks in `jobs` processes, and yield each task with its result in the order of completion.

    The result is run(task, *inputs(task)). `inputs` returns None while a task must wait for the results of other tasks. With
    jobs = 1 the tasks run in this process. `begins` is called with each task before it runs.
    """
    waiting, running = list(tasks), dict[Future[Any], Task]()
    if jobs == 1:
        while waiting:
            task, arguments = _next(waiting, inputs)
            begins(task)
            yield task, run(task, *arguments)
        return
    with _pool(jobs) as pool:
        while waiting or running:
            while len(running) < jobs and any(inputs(task) is not None for task in waiting):
                task, arguments = _next(waiting, inputs)
                begins(task)
                with _interrupts_wait():
                    running[pool.submit(run, task, *arguments)] = task
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                yield running.pop(future), future.result()


def values(names: dict[str, Any], exported: Collection[str]) -> dict[str, Any]:
    """Return the values of those names in `exported` that are defined and whose values can be sent to a process."""
    result = {}
    for name in names.keys() & set(exported):
        with suppress(pickle.PicklingError, TypeError, AttributeError):
            pickle.dumps(names[name])
            result[name] = names[name]
    return result


def _next(waiting: list[Task], inputs: Callable[[Task], Any]) -> tuple[Task, Any]:
    """Remove the first task whose inputs are complete from `waiting`; return the task and its inputs."""
    for i, task in enumerate(waiting):
        if (arguments := inputs(task)) is not None:
            return waiting.pop(i), arguments
    raise RuntimeError(f"none of {waiting} can begin: each waits for the result of another")


@contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Delay an interrupt to the end of the `with` block, because the pool cannot end a process that is starting."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    begin_process(_OBJECTS)


def _context() -> Any:
    """Return the way in which processes start: as copies of a server that has imported the package, if the system has it."""
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if hasattr(context, "set_forkserver_preload"):
        context.set_forkserver_preload(_LOADED)
    return context


def start_server() -> None:
    """Start the server of `_context` before this process imports the package, so that both import at the same time."""
    if _context().get_start_method() == "forkserver":
        from multiprocessing import forkserver  # not on all systems

        with _interrupts_wait():
            forkserver.ensure_running()


@contextmanager
def _pool(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of `jobs` processes, which ignore interrupts and end when the `with` block fails."""
    pool = ProcessPoolExecutor(jobs, mp_context=_context(), initializer=_begin)
    try:
        yield pool
    except BaseException:
        for process in list(getattr(pool, "_processes", {}).values()):
            process.terminate()
        pool.shutdown(wait=True, cancel_futures=True)
        raise
    pool.shutdown()
