"""Tasks in an executor: a few per worker in flight, results as they are finished.

An executor of `concurrent.futures`, a client of dask, or "processes" for a pool of processes on this machine.
"""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import contextmanager
from itertools import islice
from threading import Thread
from typing import Any, NamedTuple

from lagrotor.errors import InputError, IntegrationError

_PER_WORKER = 3  # tasks in flight: one that runs, one that waits beside it, one on its way
_UNKNOWN = 64  # workers of an executor that does not state their number


class Pool(NamedTuple):
    """An executor, None to run tasks here, and a function that returns the number of its workers at this moment."""

    executor: Executor | None
    workers: Callable[[], int]


def check_executor(executor: Any) -> None:
    """Raise InputError unless tasks can be run in `executor`."""
    if not (executor is None or executor == "processes" or isinstance(executor, Executor) or _is_client(executor)):
        ways = "an executor of concurrent.futures, a dask Client, 'processes' or None"
        raise InputError(f"sweep: executor = {executor!r} must be {ways}")


def _is_client(executor: Any) -> bool:
    return callable(getattr(executor, "get_executor", None)) and callable(getattr(executor, "ncores", None))


@contextmanager
def pool_of(executor: Any) -> Iterator[Pool]:
    """Yield an executor of `concurrent.futures` with its number of workers. "processes" starts a pool, and ends it afterwards."""
    if executor == "processes":
        with process_pool() as pool:
            yield Pool(pool, lambda: pool._max_workers)
    elif _is_client(executor):  # its workers come and go
        yield Pool(executor.get_executor(pure=False), lambda: max(1, _cores_of(executor)))
    else:
        yield Pool(executor, lambda: getattr(executor, "_max_workers", _UNKNOWN if executor else 1))


def _cores_of(client: Any) -> int:
    """Return the number of cores of a dask cluster at this moment; 0 without a connection to it."""
    return sum(client.ncores().values()) if client.status == "running" else 0


@contextmanager
def process_pool(workers: int | None = None) -> Iterator[Any]:
    """Yield a pool of processes, one per core unless their number is given. After an exception they are ended at once."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    context = multiprocessing.get_context("spawn")  # a fork of a process that has threads can wait forever
    pool: Any = ProcessPoolExecutor(workers or cores, context, _begin_worker)
    try:
        yield pool
    except BaseException:
        for process in (pool._processes or {}).values():
            process.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _begin_worker() -> None:
    """Leave interrupts to the parent process, and end with it, even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def end_with_parent() -> None:
        if parent := multiprocessing.parent_process():
            parent.join()
            os._exit(1)

    Thread(target=end_with_parent, daemon=True).start()


def completed(
    function: Callable[..., Any], tasks: Iterator[tuple[Any, tuple[Any, ...]]], pool: Pool
) -> Iterator[tuple[Any, Any]]:
    """Yield (key, function(*arguments)) for each task (key, arguments), in any order.

    A task is taken from the iterator when it is submitted. Tasks that have not begun are cancelled when the iteration ends early.

    Raises IntegrationError if the workers are lost.
    """
    if (executor := pool.executor) is None:
        for key, arguments in tasks:
            yield key, function(*arguments)
        return
    flying = dict[Future[Any], Any]()
    try:
        while True:
            with _say_lost_workers():
                room = _PER_WORKER * pool.workers() - len(flying)
            for key, arguments in islice(tasks, max(0, room)):
                with _say_lost_workers():
                    flying[executor.submit(function, *arguments)] = key
            if not flying:
                return
            for future in wait(flying, return_when=FIRST_COMPLETED).done:
                with _say_lost_workers():
                    result = future.result()
                yield flying.pop(future), result
    finally:
        for future in flying:
            future.cancel()


@contextmanager
def _say_lost_workers() -> Iterator[None]:
    try:
        yield
    except Exception as error:
        lost = isinstance(error, BrokenExecutor | CancelledError | OSError)
        if not (lost or type(error).__module__.startswith("distributed")):
            raise
        why = "killed, out of memory, or a script without: if __name__ == '__main__'"
        says = f"sweep: the executor lost its workers ({type(error).__name__}): {why}"
        raise IntegrationError(f"{says}; with folder= the same call goes on") from error
