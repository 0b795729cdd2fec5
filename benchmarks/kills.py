"""Kills commands at random moments and compares what they leave after a resume.

    ./run bench kills [--count N] [--seed N] [--json FILE]

Commands are a run, a solve and a system, the latter two with a checkpoint. Signals are SIGINT, SIGTERM,
SIGHUP and SIGKILL, sent to the command, to one of its worker processes or to its whole process group, at a
random moment of the time that it takes. Then it is resumed, after being killed again or not, and the result
is compared with that of a command that was left alone, times aside. Faults are: another result, an exit code
that is none of the documented ones, a traceback, a process or a temporary file that is left.
"""

import argparse
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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MARK = "HOLDFAST_KILLS"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
TARGETS = ("command", "worker", "group")
# Kills of one command before it may go on to its end.
KILLS = 2
END_S = 120.0
# Five equations of a ring of cubics: some hundred roots, and a second or two for two workers.
RING = {
    "variables": {f"x{k}": [-3, 3] for k in range(5)},
    "equations": [f"x{k}^3 - 2*x{(k + 1) % 5}*x{k} + 0.3*x{(k + 2) % 5} - 0.1" for k in range(5)],
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
            lambda f: ["run", "upholding", "--candidates", "4", "--seed", str(seed), *few,
                       "--out", str(f / "run")],
            lambda f: ["--resume"] if (f / "run" / "run.json").exists() else [],
            run_result,
        ),
        "solve": Work(
            lambda f: ["solve", "incision", "--pure", "--candidates", "8", *few, *with_checkpoint(f),
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


def begin(words: list[str], mark: str) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "holdfast.pipeline.cli", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, MARK: mark},
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


def send(process: "subprocess.Popen[str]", mark: str, target: str, number: int, rng: random.Random) -> None:
    """Sends a signal to the command, to a worker (to the command where there is none) or to the group."""
    others = [pid for pid in marked(mark) if pid != process.pid]
    try:
        if target == "group":
            os.killpg(process.pid, number)
        elif target == "worker" and others:
            # What ends a worker is up to nobody but the system.
            os.kill(rng.choice(others), signal.SIGKILL)
        else:
            process.send_signal(number)
    except ProcessLookupError:
        return


def faults_of(process: "subprocess.Popen[str]", mark: str, folder: Path, killed: int) -> list[str]:
    """What is wrong once the command has ended."""
    try:
        _, err = process.communicate(timeout=END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return ["did not end"]
    faults = []
    if process.returncode not in (0, 130, -killed):
        faults.append(f"exit code {process.returncode}: {err[-200:]!r}")
    if "Traceback" in err:
        faults.append(f"traceback: {err[-400:]!r}")
    deadline = time.monotonic() + 2.0
    while (left := list(marked(mark))) and time.monotonic() < deadline:
        time.sleep(0.05)
    if left:
        faults.append(f"{len(left)} processes are left")
    return faults


def trial(
    name: str, work: Work, whole_s: float, expected: Any, rng: random.Random, mark: str
) -> tuple[list[str], int]:
    """Faults, and the number of signals that were sent."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "ring.json").write_text(json.dumps(RING), "utf-8")
        faults: list[str] = []
        kills = rng.randint(1, KILLS)
        for attempt in range(kills + 1):
            words = [*work.words(folder), *(work.resume(folder) if attempt else [])]
            process = begin(words, mark)
            number = 0
            if attempt < kills:
                time.sleep(rng.uniform(0.0, whole_s))
                number, target = rng.choice(SIGNALS), rng.choice(TARGETS)
                send(process, mark, target, number, rng)
            faults += [f"{name}, {signal.Signals(number).name if number else 'resumed'}: {fault}"
                       for fault in faults_of(process, mark, folder, number)]  # fmt: skip
        temporary = [str(path.relative_to(folder)) for path in folder.rglob(".*")]
        if temporary:
            faults.append(f"{name}: left {temporary[:3]}")
        try:
            if work.result(folder) != expected:
                faults.append(f"{name}: another result")
        except OSError as error:
            faults.append(f"{name}: no result: {error}")
        return faults, kills


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=100, help="signals to send, at least")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", help="write the counts to this file")
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    commands = works(arguments.seed)
    reference: dict[str, tuple[float, Any]] = {}
    for name, work in commands.items():
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            (folder / "ring.json").write_text(json.dumps(RING), "utf-8")
            started = time.monotonic()
            begin(work.words(folder), "left alone").communicate()
            reference[name] = time.monotonic() - started, work.result(folder)
        print(f"{name}: {reference[name][0]:.1f} s when left alone", flush=True)
    sent: Counter[str] = Counter()
    faults: list[str] = []
    for number in range(10**6):
        if sum(sent.values()) >= arguments.count:
            break
        name = rng.choice(list(commands))
        found, kills = trial(name, commands[name], *reference[name], rng, f"{os.getpid()}-{number}")
        sent[name] += kills
        faults += found
        for fault in found:
            print(f"FAULT {fault}", flush=True)
    print(f"{sum(sent.values())} signals ({dict(sent)}), {len(faults)} faults")
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"sent": sent, "faults": faults}, indent=1), "utf-8")
    return 1 if faults else 0


if __name__ == "__main__":
    raise SystemExit(main())
