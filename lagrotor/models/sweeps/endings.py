"""The endings of many runs as arrays. An `Ending` is made only when one is asked for."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrotor.numerics.arrays import Array
from lagrotor.numerics.run import Ending

# In this order, which the files of sweeps use. A run of one of the first two kinds reached its last time.
KINDS: tuple[Any, ...] = ("end", "lost", "budget", "singular", "event", "stopped")


@dataclass(frozen=True, eq=False)
class Endings(Sequence[Ending]):
    """The endings of n runs: indices into KINDS, times in s (each (n,)), and the reasons, {number of the run: reason}."""

    kinds: NDArray[np.int8]
    times: Array
    reasons: Mapping[int, str]

    @classmethod
    def of(cls, endings: Sequence[Ending]) -> "Endings":
        """Return the endings of some runs as arrays."""
        if isinstance(endings, cls):
            return endings
        kinds = np.array([KINDS.index(ending.kind) for ending in endings], np.int8)
        reasons = {i: ending.reason for i, ending in enumerate(endings) if ending.reason}
        return cls(kinds, np.array([ending.at for ending in endings], float), reasons)

    @property
    def early(self) -> NDArray[np.bool_]:
        """True for the runs that ended before their last time, (n,)."""
        return self.kinds > KINDS.index("lost")

    def __len__(self) -> int:
        return len(self.kinds)

    def __getitem__(self, i: Any) -> Any:
        if isinstance(i, slice):
            return tuple(self[k] for k in range(len(self))[i])
        i = range(len(self))[i]
        return Ending(KINDS[self.kinds[i]], float(self.times[i]), self.reasons.get(i, ""))
