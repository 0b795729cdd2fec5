"""Kills commands at random moments and compares what they leave after a resume.

    ./run bench kills [--count N] [--seed N] [--json FILE] [COMMAND ...]

Commands are a run, a solve and a system, the latter two with a checkpoint. Signals are SIGINT, SIGTERM,
SIGHUP and SIGKILL, sent to the command, to one of its worker processes or to its whole process group, at a
random moment of the time that it takes. Then it is resumed, after being killed again or not, and the result
is compared with that of a command that was left alone, times aside. Faults are: another result, an exit code
that is none of the documented ones, a traceback, a process or a temporary file that is left.

With --json, what has been done is written after every trial, and the same call goes on where an earlier one
was left. What it has started ends with it, also when it is killed.
"""

import argparse
import ctypes
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from holdfast.base.files.output_file import write_json

MARK = "HOLDFAST_KILLS"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
TARGETS = ("command", "worker", "group")
# Kills of one command before it may go on to its end.
KILLS = 2
END_S = 180.0
PR_SET_PDEATHSIG = 1
# Seven equations of a ring of cubics: 157 solutions, and a second for two workers.
NAMES = [f"x{k}" for k in range(7)]
RING = {
    "variables": {x: [-9, 9] for x in NAMES},
    "equations": [
        f"{x}^3 - 2*{NAMES[k - 6]}*{NAMES[k - 4]} + 0.3*{NAMES[k - 5]}^2 - 3*{x} + 0.1"
        for k, x in enumerate(NAMES)
    ],
}


@dataclass(frozen=True)
class Work:
    """A command with its result.

    Attributes:
        words: of the command line, given the folder it works in.
        resume: words that are added to go on.
        result: what the folder holds in the end, times aside.
    """

    words: Callable[[Path], list[str]]
    resume: Callable[[Path], list[str]]
    result: Callable[[Path], Any]


@dataclass
class Kill:
    """One signal, and what came of it.

    Attributes:
        signal: its name; of a worker it is SIGKILL, for what ends one is up to nobody but the system.
        target: what it was sent to; a worker's goes to the command while there is none.
        after_s: seconds after the command was started.
        ended_s: seconds from the signal to the end of the command, which a killed worker does not end.
        code: the exit code of the command.
    """

    signal: str
    target: str
    after_s: float
    ended_s: float = 0.0
    code: int = 0


@dataclass
class Trial:
    """A command that is killed and resumed."""

    number: int
    command: str
    kills: list[Kill] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


def timeless(data: Any) -> Any:
    """JSON without the fields that tell times, or how often the work was taken up."""
    if isinstance(data, dict):
        return {key: timeless(value) for key, value in data.items() if "seconds" not in key}
    return [timeless(value) for value in data] if isinstance(data, list) else data


def run_result(folder: Path) -> Any:
    files = [folder / "run" / "run.json", *sorted((folder / "run" / "grasps").glob("*.json"))]
    return [timeless(json.loads(file.read_text("utf-8"))) for file in files]


def json_result(folder: Path) -> Any:
    return timeless(json.loads((folder / "result.json").read_text("utf-8")))


def with_checkpoint(folder: Path) -> list[str]:
    return ["--checkpoint", str(folder / "kept")]


def works(seed: int) -> dict[str, Work]:
    """What is killed."""
    few, out = ["--workers", "2", "--quiet", "--budget", "900"], "result.json"
    return {
        "run": Work(
            lambda f: ["run", "upholding", "--candidates", "2", "--quick", "--seed", str(seed), *few,
                       "--out", str(f / "run")],
            lambda f: ["--resume"] if (f / "run" / "run.json").exists() else [],
            run_result,
        ),
        "solve": Work(
            lambda f: ["solve", "upholding", "--candidates", "1500", *few, *with_checkpoint(f),
                       "--json", str(f / out)],
            lambda f: ["--resume"],
            json_result,
        ),
        "system": Work(
            lambda f: ["system", str(f / "ring.json"), *few, *with_checkpoint(f), "--json", str(f / out)],
            lambda f: ["--resume"],
            json_result,
        ),
    }  # fmt: skip


def end_with_parent(parent: int, libc: ctypes.CDLL) -> None:
    """Runs in a child before its command: the kernel kills it when this benchmark ends, whatever ends it."""
    # A shell that starts this in the background has it ignore Ctrl-C, and what it starts would do so too.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


def begin(words: list[str], mark: str) -> "subprocess.Popen[str]":
    parent, libc = os.getpid(), ctypes.CDLL(None)
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "holdfast", *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, MARK: mark},
        preexec_fn=lambda: end_with_parent(parent, libc),
    )


def marked(mark: str) -> Iterator[int]:
    """Processes that were started, directly or not, with this mark."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                environment = (entry / "environ").read_bytes()
            except OSError:
                continue
            if f"{MARK}={mark}".encode() in environment.split(b"\0"):
                yield int(entry.name)


def send(process: "subprocess.Popen[str]", mark: str, kill: Kill, rng: random.Random) -> None:
    """Sends a signal to the command, to a worker (to the command where there is none) or to the group."""
    others = [pid for pid in marked(mark) if pid != process.pid] if kill.target == "worker" else []
    with suppress(ProcessLookupError):
        if kill.target == "group":
            os.killpg(process.pid, signal.Signals[kill.signal])
        elif others:
            os.kill(rng.choice(others), signal.SIGKILL)
            kill.signal = signal.SIGKILL.name
        else:
            kill.target = "command"
            process.send_signal(signal.Signals[kill.signal])


def faults_of(process: "subprocess.Popen[str]", mark: str, kill: Kill | None) -> list[str]:
    """What is wrong once the command has ended."""
    try:
        _, err = process.communicate(timeout=END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return ["did not end"]
    faults = []
    codes = [0]
    if kill is not None and kill.target != "worker":
        codes = [0, 130, -signal.Signals[kill.signal]]
    if process.returncode not in codes:
        faults.append(f"exit code {process.returncode}: {err[-200:]!r}")
    if "Traceback" in err:
        faults.append(f"traceback: {err[-400:]!r}")
    deadline = time.monotonic() + 2.0
    while (left := list(marked(mark))) and time.monotonic() < deadline:
        time.sleep(0.05)
    if left:
        faults.append(f"{len(left)} processes are left")
    return faults


def prepared(scratch: str) -> Path:
    folder = Path(scratch)
    (folder / "ring.json").write_text(json.dumps(RING), "utf-8")
    return folder


def try_killing(trial: Trial, work: Work, whole_s: float, expected: Any, rng: random.Random) -> None:
    """Kills a command once or more, resumes it, and notes the faults."""
    mark = f"{os.getpid()}-{trial.number}"
    with tempfile.TemporaryDirectory() as scratch:
        folder = prepared(scratch)
        kills = rng.randint(1, KILLS)
        for attempt in range(kills + 1):
            words = [*work.words(folder), *(work.resume(folder) if attempt else [])]
            process, kill = begin(words, mark), None
            if attempt < kills:
                moment = rng.uniform(0.0, whole_s)
                kill = Kill(rng.choice(SIGNALS).name, rng.choice(TARGETS), round(moment, 2))
                time.sleep(moment)
                send(process, mark, kill, rng)
                sent = time.monotonic()
                trial.kills.append(kill)
            what = f"{kill.signal} to {kill.target} after {kill.after_s} s" if kill else "resumed"
            trial.faults += [f"{what}: {fault}" for fault in faults_of(process, mark, kill)]
            if kill:
                kill.ended_s, kill.code = round(time.monotonic() - sent, 2), process.returncode
        if temporary := [str(path.relative_to(folder)) for path in folder.rglob(".*")]:
            trial.faults.append(f"left {temporary[:3]}")
        try:
            if work.result(folder) != expected:
                trial.faults.append("another result")
        except OSError as error:
            trial.faults.append(f"no result: {error}")


def left_alone(name: str, work: Work) -> tuple[float, Any]:
    """Seconds that a command takes, and its result; it ran before, so nothing is compiled."""
    for _ in range(2):
        with tempfile.TemporaryDirectory() as scratch:
            folder = prepared(scratch)
            started = time.monotonic()
            process = begin(work.words(folder), "left alone")
            _, err = process.communicate()
            took_s = time.monotonic() - started
            if process.returncode != 0:
                raise SystemExit(f"{name}, left alone: exit code {process.returncode}: {err[-400:]}")
            result = work.result(folder)
    print(f"{name}: {took_s:.1f} s when left alone", flush=True)
    return took_s, result


def earlier(path: Path | None, seed: int, names: list[str]) -> list[Trial]:
    """Trials that an earlier call with the same seed and commands has written."""
    if path is None or not path.exists():
        return []
    data = json.loads(path.read_text("utf-8"))
    if (data["seed"], data["commands"]) != (seed, names):
        raise SystemExit(f"{path}: is of another seed or other commands; name another file")
    return [
        Trial(**{**trial, "kills": [Kill(**kill) for kill in trial["kills"]]}) for trial in data["trials"]
    ]


def progress(trial: Trial, sent: int, count: int, rate: float) -> str:
    kills = ", ".join(f"{kill.signal} to {kill.target} after {kill.after_s} s" for kill in trial.kills)
    verdict = "; ".join(f"FAULT {fault}" for fault in trial.faults) or "as left alone"
    return f"{sent} of {count} signals, {rate:.1f} a minute: {trial.command}, {kills}: {verdict}"


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("commands", nargs="*", metavar="COMMAND", help="run, solve, system; all of them")
    parser.add_argument("--count", type=int, default=100, help="signals to send, at least")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="what was done; the same call goes on from there")
    arguments = parser.parse_args()
    # Ends by an exception, so that scratch folders go; the kernel ends what was started.
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda received, _: sys.exit(128 + received))
    commands = works(arguments.seed)
    names = arguments.commands or list(commands)
    if unknown := set(names) - set(commands):
        parser.error(f"unknown command {min(unknown)!r}; known: {', '.join(commands)}")
    trials = earlier(arguments.json, arguments.seed, names)
    reference = {name: left_alone(name, commands[name]) for name in names}
    started, before = time.monotonic(), sum(len(trial.kills) for trial in trials)
    while (sent := sum(len(trial.kills) for trial in trials)) < arguments.count:
        rng = random.Random(f"{arguments.seed} {len(trials)}")
        trial = Trial(len(trials), rng.choice(names))
        try_killing(trial, commands[trial.command], *reference[trial.command], rng)
        trials.append(trial)
        if arguments.json:
            done = {"seed": arguments.seed, "commands": names, "trials": [asdict(each) for each in trials]}
            write_json(arguments.json, done)
        sent += len(trial.kills)
        rate = (sent - before) / (time.monotonic() - started) * 60
        print(progress(trial, sent, arguments.count, rate), flush=True)
    by_command = Counter(dict.fromkeys(names, 0))
    slowest: dict[str, float] = {}
    for trial in trials:
        by_command[trial.command] += len(trial.kills)
        for kill in trial.kills:
            if kill.target != "worker":
                slowest[kill.signal] = max(slowest.get(kill.signal, 0.0), kill.ended_s)
    faults = sum(len(trial.faults) for trial in trials)
    print(f"{sent} signals ({dict(by_command)}), {faults} faults")
    print(f"longest from a signal to the end of what it was sent to: {slowest}")
    return 1 if faults else 0


if __name__ == "__main__":
    raise SystemExit(main())
