"""A setup and its worker for the tests of the pool, in a module that a fresh process can import."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from holdfast.errors import InputError


@dataclass(frozen=True, eq=False)
class Large:
    """Something that no message should hold; the setup's pickle tells when it was written out."""

    numbers: list[int] = field(default_factory=lambda: list(range(100_000)))


@dataclass(frozen=True)
class Job:
    """What to do, to what; `large` is the setup's own or None."""

    word: str
    number: int = 0
    large: Large | None = None


@dataclass(frozen=True, eq=False)
class Setup:
    """Makes workers that multiply by `factor`.

    Attributes:
        factor: of every result.
        large: what both ends have.
        fails: how making a worker ends: "", "raises" or "dies".
    """

    factor: int = 1
    large: Large = field(default_factory=Large)
    fails: str = ""

    @property
    def shared(self) -> tuple[object, ...]:
        return (self.large,)

    def new_worker(self) -> "ToyWorker":
        if self.fails == "raises":
            raise InputError("the toy", "field", "must not fail")
        if self.fails == "dies":
            os._exit(7)
        return ToyWorker(self)

    def give_up(self, job: Job) -> tuple[str, int]:
        return "given up", job.number


class ToyWorker:
    """Does what a job's word says."""

    def __init__(self, setup: Setup):
        self.setup = setup

    def work(self, job: Job) -> object:
        doing: dict[str, Callable[[Job], object]] = {
            "multiply": lambda job: self.setup.factor * job.number,
            "die": lambda job: os._exit(9),
            "sleep": lambda job: time.sleep(job.number),
            "pid": lambda job: (time.sleep(0.05), os.getpid())[1],
            "print": lambda job: print("on standard output"),
            "is yours": lambda job: job.large is self.setup.large,
            "give back": lambda job: (job.number, self.setup.large),
            "raise": self._raise,
            "answer with what can't be sent": lambda job: lambda: None,
            "answer with an error": lambda job: KeyError("an answer"),
        }
        return doing[job.word](job)

    def _raise(self, job: Job) -> object:
        kinds = (
            InputError("a file", "a field", "what is allowed"),
            FileNotFoundError(2, "no such thing", "a path"),
            Unsendable("this can't", "be sent"),
        )
        raise kinds[job.number]


class Unsendable(Exception):
    """Its message is made of two arguments, so the usual way of pickling it fails when it is read."""

    def __init__(self, first: str, second: str):
        super().__init__(f"{first} {second}")
