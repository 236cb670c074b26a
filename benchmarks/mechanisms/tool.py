"""A tool on a mechanism: how it is made ready, its right-hand side, and its runs."""

import functools
import gc
import multiprocessing
import signal
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.algebra.subexpressions import forget
from lagrotor.benchmark.records import MechanismKind

Array = NDArray[np.float64]
Rhs = Callable[[float, Array], "Array | list[float]"]  # (t, (q, v)) → (v, a)
Run = Callable[[Array, Array, float], Array]  # (start, times from 0, setting) → coordinates (n, N)


@dataclass(frozen=True)
class Ready:
    """A tool's right-hand side, and its own way to run where it has one; otherwise scipy's DOP853 and LSODA run it."""

    rhs: Rhs
    run: Run | None = None
    settings: tuple[float, ...] = ()  # of its own runs, from coarse to fine: tolerances, or steps in s


@dataclass(frozen=True)
class Tool:
    """prepare(kind, n) makes it ready; module: what has to be importable; install: what pip installs for it."""

    prepare: Callable[[MechanismKind, int], Ready]
    module: str = "sympy"
    install: str = ""
    others: tuple[str, ...] = ()  # modules needed besides


def forget_all() -> None:
    """Let go of what sympy and lagrotor remember of what they made before, for it to be made anew."""
    forget()
    for one in gc.get_objects():
        if isinstance(one, functools._lru_cache_wrapper) and (one.__module__ or "").startswith("lagrotor"):
            one.cache_clear()


def in_own_process(work: Callable[..., None], seconds: float, *given: Any) -> Any:
    """What work(send, spend, *given) sends, in a new process that ends when it has used `seconds` of processor time since it
    called spend(); the text "over … s" if it did, and "its process ended" if that died.
    """
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(sender, work, seconds, given), daemon=True)
    process.start()
    sender.close()
    try:
        return receiver.recv()
    except EOFError:
        process.join()
        return f"over {seconds:g} s" if process.exitcode == -signal.SIGPROF else "its process ended"
    finally:
        process.kill()
        process.join()


def _work(sender: Any, work: Callable[..., None], seconds: float, given: Any) -> None:
    work(sender.send, lambda: signal.setitimer(signal.ITIMER_PROF, seconds), *given)
