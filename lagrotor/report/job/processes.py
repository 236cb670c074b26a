"""Tasks in parallel processes. Results come in the order of completion; no process remains when the run is stopped."""

import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
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
    with _pool(jobs) as submit:
        while waiting or running:
            while len(running) < jobs and any(inputs(task) is not None for task in waiting):
                task, arguments = _next(waiting, inputs)
                begins(task)
                running[submit(run, task, *arguments)] = task
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


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    begin_process(_OBJECTS)


def _end_with_parent() -> None:
    """End this process when its parent has ended, even if the parent was killed."""
    if parent := multiprocessing.parent_process():
        parent.join()
        os._exit(1)


def _context() -> Any:
    """Return the way in which processes start: as copies of a server that has imported the package, if the system has it."""
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if hasattr(context, "set_forkserver_preload"):
        context.set_forkserver_preload(_LOADED)
    return context


def _start_server() -> None:
    if _context().get_start_method() == "forkserver":
        from multiprocessing import forkserver, resource_tracker  # not on all systems

        resource_tracker.ensure_running()  # at its own start it would unblock the interrupt
        # The server inherits the mask: an interrupt of the process group would stop its imports with a traceback.
        previous = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            forkserver.ensure_running()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, previous)


def _stop_server() -> None:
    with suppress(ImportError):  # no server on this system
        from multiprocessing import forkserver

        running: Any = forkserver._forkserver
        if running._forkserver_pid is not None:
            os.kill(running._forkserver_pid, signal.SIGKILL)  # it may still be importing
            running._stop()


@contextmanager
def server() -> Iterator[None]:
    """Start the server of `_context`, and stop it if the `with` block fails.

    If the block begins before this process imports the package, both import it at the same time.
    """
    try:
        _start_server()
        yield
    except BaseException:
        _stop_server()
        raise


@contextmanager
def ending_at_interrupt() -> Iterator[None]:
    """Let an interrupt end this process at once within the `with` block, for imports: in some places they lose an exception."""

    def end(number: int, frame: Any) -> None:
        _stop_server()
        os.write(2, b"lagrotor: interrupted\n")
        os._exit(130)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


@contextmanager
def _pool(jobs: int) -> Iterator[Callable[..., Future[Any]]]:
    """Yield the function that submits a call to `jobs` processes, which ignore interrupts and end when the `with` block fails.

    A process starts in a thread: the start waits for the server's imports, and this thread must heed an interrupt meanwhile.
    """
    pool, starter = ProcessPoolExecutor(jobs, mp_context=_context(), initializer=_begin), ThreadPoolExecutor(1)
    try:
        with server():
            yield lambda run, *arguments: starter.submit(lambda: pool.submit(run, *arguments)).result()
    except BaseException:
        starter.shutdown(cancel_futures=True)
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.terminate()
        pool.shutdown(cancel_futures=True)
        raise
    starter.shutdown()
    pool.shutdown()
