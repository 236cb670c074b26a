"""The machine on which a comparison is made, and the versions of what is compared."""

import os
import platform
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

# Package → the module by which it is found.
_PACKAGES = {
    "numpy": "numpy",
    "scipy": "scipy",
    "sympy": "sympy",
    "heyoka": "heyoka",
    "pydy": "pydy",
    "casadi": "casadi",
    "scikit-sundae": "sksundae",
    "mujoco": "mujoco",
    "pin": "pinocchio",
    "drake": "pydrake",
    "symbrim": "symbrim",
    "Cython": "Cython",
    "CyRK": "CyRK",
    "numba": "numba",
    "jax": "jax",
    "diffrax": "diffrax",
}


def machine() -> dict[str, Any]:
    """Processor, cores and Python of this machine."""
    return {"processor": _processor(), "cores": os.cpu_count(), "Python": platform.python_version()}


def versions() -> dict[str, str]:
    """Of the packages that are compared and installed."""
    return {name: version(name) for name, module in _PACKAGES.items() if find_spec(module)}


def _processor() -> str:
    """The processor's name as the system gives it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())
