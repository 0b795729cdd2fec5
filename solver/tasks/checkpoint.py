"""What the checkpoint of a task's search holds."""

import hashlib
import json
from collections.abc import Sequence

import numpy as np

from ... import __version__
from ..contacts import Certificate, Configuration, State
from ..contraction import Box
from ..proof import form_data
from ..search import Arrays, Snapshot, pack, unpack
from .worker import TaskWorker

__all__ = ["fingerprint", "restore", "snapshot"]


def fingerprint(worker: TaskWorker) -> str:
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


def snapshot(found: Sequence[Configuration], covered: Sequence[Box], counters: dict[str, int]) -> Snapshot:
    """What a search of a task keeps beside the state of branch and prune.

    Args:
        found: configurations.
        covered: boxes of the cover.
        counters: further numbers.
    """
    return Snapshot(counters, {**pack("covered", Box, covered), **_pack_configurations(found)})


def restore(saved: Snapshot, worker: TaskWorker) -> tuple[list[Configuration], list[Box]]:
    """The configurations and the boxes of the cover that were kept."""
    return _unpack_configurations(saved.arrays, worker), unpack("covered", Box, saved.arrays)


def _pack_configurations(found: Sequence[Configuration]) -> Arrays:
    proofs = [c.certificate for c in found if c.certificate is not None]
    assert len(proofs) == len(found), "a search finds certified configurations only"
    return {
        **pack("state", State, [c.state for c in found]),
        "found.residual": np.array([c.residual_m for c in found], dtype=np.float64),
        "found.lower": np.array([p.lower for p in proofs], dtype=np.float64),
        "found.upper": np.array([p.upper for p in proofs], dtype=np.float64),
        "found.opposed": np.array([p.opposed_within_rad for p in proofs], dtype=np.float64),
        "found.fixed": np.array([[name in p.fixed for name in p.names] for p in proofs], dtype=bool),
    }


def _unpack_configurations(arrays: Arrays, worker: TaskWorker) -> list[Configuration]:
    names = worker.formulation.system.names
    found = []
    for row, state in enumerate(unpack("state", State, arrays)):
        fixed = tuple(name for name, held in zip(names, arrays["found.fixed"][row], strict=True) if held)
        lower, upper = arrays["found.lower"][row], arrays["found.upper"][row]
        opposed = tuple(arrays["found.opposed"][row].tolist())
        certificate = Certificate(names, lower, upper, fixed, opposed)
        residual_m = float(arrays["found.residual"][row])
        found.append(Configuration(worker.setup.task, state, residual_m, certificate))
    return found
