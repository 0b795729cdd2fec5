"""Grasps for measurements of the hold test, and findings on file with which a stopped one goes on."""

import json
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from holdfast.base.files.output_file import write_json
from holdfast.grasping import strengthen_and_clear
from holdfast.mjcf import HoldSettings
from holdfast.objects import Task
from holdfast.retraction import ClearConfiguration, retract
from holdfast.solver import Configuration, solve

BUDGET_S = 60.0
Finding = dict[str, Any]


@lru_cache(maxsize=32)
def found(task: Task, count: int, seed: int) -> tuple[Configuration, ...]:
    """Certified configurations of a task."""
    return tuple(solve(task, candidates=count, seed=seed, budget_s=BUDGET_S).configurations)


def as_found(configuration: Configuration) -> Configuration | None:
    """The configuration made clear and nothing else; None where that fails."""
    outcome = retract(configuration)
    if not isinstance(outcome, ClearConfiguration) or not outcome.configuration.certified:
        return None
    return outcome.configuration


def strengthened(configuration: Configuration, settings: HoldSettings) -> Configuration | None:
    """Strengthening and retraction in turns, as a run does; None where they do not end clear."""
    clearing = strengthen_and_clear(configuration, settings=settings)
    return clearing.configuration if clearing.is_clear and clearing.configuration.certified else None


class Findings:
    """Findings by key, written after each, so that the next call goes on where one was stopped.

    Args:
        path: a JSON file; None keeps nothing.
        assumed: what they depend on; a file with something else is not gone on with.
    """

    def __init__(self, path: Path | None, assumed: Finding):
        self._path, self._assumed = path, assumed
        self.by_key: dict[str, list[Finding]] = {}
        if path is not None and path.exists():
            record = json.loads(path.read_text("utf-8"))
            if record["assumed"] != assumed:
                sys.exit(f"{path}: belongs to {record['assumed']}, not to {assumed}")
            self.by_key = record["findings"]

    def collect(
        self, jobs: dict[str, Sequence[Any]], work: Callable[..., list[Finding]], workers: int, stop_s: float
    ) -> bool:
        """Does those of the jobs (arguments of `work` by key) that are missing; False where time ran out."""
        missing = {key: job for key, job in jobs.items() if key not in self.by_key}
        end = time.monotonic() + stop_s
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            # One job a worker at a time, so that what is under way when time runs out is little.
            waiting, running = list(missing.items()), {}
            while waiting or running:
                while waiting and len(running) < workers and time.monotonic() < end:
                    key, job = waiting.pop(0)
                    running[pool.submit(work, *job)] = key
                if not running:
                    return False
                done = next(as_completed(running))
                self._add(running.pop(done), done.result())
        return True

    def of(self, keys: Iterable[str]) -> list[Finding]:
        """Findings of these keys, in their order, as far as there are any."""
        return [finding for key in keys for finding in self.by_key.get(key, [])]

    def _add(self, key: str, findings: list[Finding]) -> None:
        self.by_key[key] = findings
        print(f"{key}: {len(findings)}", file=sys.stderr, flush=True)
        if self._path is not None:
            write_json(self._path, {"assumed": self._assumed, "findings": self.by_key})
