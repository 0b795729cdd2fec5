"""What the checkpoint of a task's search holds."""

import hashlib
import json
from collections.abc import Sequence

import numpy as np

from ... import __version__
from ..contacts import Certificate, Configuration, State
from ..contraction import Box
from ..proof import form_data
from ..search import Arrays, SearchState, Snapshot, pack, pack_state, unpack, unpack_state
from .worker import BoxWorker

__all__ = ["fingerprint", "restore", "snapshot"]

TaskState = SearchState[Box, Configuration]


def fingerprint(worker: BoxWorker) -> str:
    """Of everything that decides the result of a search: version, system, free joints, settings."""
    setup = worker.setup
    what = [
        __version__,
        form_data(worker.form),
        worker.formulation.system.names,
        worker.certifier.q_free.tolist(),
        setup.task.limits.tolist(),
        [setup.sigma, setup.seed, setup.pure, setup.order.value, setup.cover],
    ]
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()


def snapshot(state: TaskState, counters: dict[str, float], covered: Sequence[Box]) -> Snapshot:
    """Where a search stands.

    Args:
        state: of the search.
        counters: further numbers to keep.
        covered: further boxes to keep.
    """
    packed = pack_state(state, Box)
    arrays = {**packed.arrays, **pack("covered", Box, covered), **_pack_configurations(state.solutions)}
    return Snapshot({**packed.numbers, "counters": counters}, arrays)


def restore(saved: Snapshot, state: TaskState, worker: BoxWorker) -> tuple[dict[str, float], list[Box]]:
    """Puts a snapshot into a fresh state.

    Returns:
        The further numbers and boxes that were kept.
    """
    unpack_state(saved, Box, state)
    state.solutions = _unpack_configurations(saved.arrays, worker)
    return dict(saved.numbers["counters"]), unpack("covered", Box, saved.arrays)


def _pack_configurations(found: Sequence[Configuration]) -> Arrays:
    proofs = [c.certificate for c in found if c.certificate is not None]
    assert len(proofs) == len(found), "a search finds certified configurations only"
    return {
        **pack("state", State, [c.state for c in found]),
        "found.residual": np.array([c.residual_m for c in found], dtype=np.float64),
        "found.lower": np.array([p.lower for p in proofs], dtype=np.float64),
        "found.upper": np.array([p.upper for p in proofs], dtype=np.float64),
        "found.fixed": np.array([[name in p.fixed for name in p.names] for p in proofs], dtype=bool),
    }


def _unpack_configurations(arrays: Arrays, worker: BoxWorker) -> list[Configuration]:
    names = worker.formulation.system.names
    found = []
    for row, state in enumerate(unpack("state", State, arrays)):
        fixed = tuple(name for name, held in zip(names, arrays["found.fixed"][row], strict=True) if held)
        certificate = Certificate(names, arrays["found.lower"][row], arrays["found.upper"][row], fixed)
        residual_m = float(arrays["found.residual"][row])
        found.append(Configuration(worker.setup.task, state, residual_m, certificate))
    return found
