"""Runs on a disk that is full at one point or another, and goes on once there is room.

    ./run bench full_disk [--count N] [--json FILE]

Each run writes to a file system in memory that holds less than what a run writes in all: a share of it that
grows from point to point. It has to end with exit code 2 and one line that names the file and says why, and
what lies there has to be whole. Then there is room, and --resume has to lead to the result of a run that was
never in need, times aside. The file systems are mounted where nobody else sees them, by `unshare`, which
needs root or a system that lets users have name spaces.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from holdfast.base.files.output_file import write_json
from kills import run_result
from parts.places import RUN

PAGE = 4096
ROOM_BYTES = 256 * 1024 * 1024
INSIDE = "HOLDFAST_FULL_DISK"
WORDS = ["run", "upholding", "--candidates", "2", "--workers", "2", "--quiet", "--budget", "900"]


@dataclass
class Point:
    """A run whose disk held only so much.

    Attributes:
        held_bytes: what the disk held.
        code: the exit code of the run on it.
        said: its line.
        faults: what was wrong, then or after resuming.
    """

    held_bytes: int
    code: int = 0
    said: str = ""
    faults: list[str] = field(default_factory=list)


def holdfast(folder: Path, *more: str) -> "subprocess.CompletedProcess[str]":
    words = [sys.executable, "-P", "-m", "holdfast", *WORDS, "--out", str(folder / "run"), *more]
    return subprocess.run(words, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


def mount(folder: Path, size: int, *options: str) -> None:
    subprocess.run(
        ["mount", "-t", "tmpfs", "-o", ",".join([*options, f"size={size}"]), "none", str(folder)], check=True
    )


def taken_bytes(folder: Path) -> int:
    return sum(-(-path.stat().st_size // PAGE) * PAGE for path in folder.rglob("*") if path.is_file())


def halves(folder: Path) -> list[str]:
    """Files that are not whole."""
    found = []
    for path in folder.rglob("*"):
        if not path.is_file():
            continue
        data = path.read_bytes()
        try:
            if path.suffix == ".json":
                json.loads(data)
            elif path.suffix == ".xml":
                ElementTree.fromstring(data)
            elif path.suffix not in (".png", ".html"):
                raise ValueError("is no file of a run")
            elif not data.rstrip().endswith((b"IEND\xaeB`\x82", b"</html>")):
                raise ValueError("has no end")
        except (ValueError, ElementTree.ParseError) as error:
            found.append(f"{path.relative_to(folder)}: {error}")
    return found


def try_full(held: int, expected: Any) -> Point:
    point = Point(held)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        mount(folder, held)
        try:
            done = holdfast(folder)
            point.code, point.said = done.returncode, done.stderr.replace(scratch, "DISK")
            starts, ends = point.said.startswith("holdfast: DISK/run"), "no space left on device\n"
            if point.code != 2 or point.said.count("\n") != 1 or not (starts and point.said.endswith(ends)):
                point.faults.append("ends otherwise than with one line that names the file")
            point.faults += [f"full: {half}" for half in halves(folder)]
            mount(folder, ROOM_BYTES, "remount")
            has_record = (folder / "run" / "run.json").exists()
            done = holdfast(folder, *(["--resume"] if has_record else []))
            if done.returncode != 0:
                point.faults.append(f"resumed: exit code {done.returncode}: {done.stderr[-300:]!r}")
            point.faults += [f"resumed: {half}" for half in halves(folder)]
            if run_result(folder) != expected:
                point.faults.append("resumed: another result")
            missing = [
                name for name in ("report.html", "media", "grasps") if not (folder / "run" / name).exists()
            ]
            point.faults += [f"resumed: no {name}" for name in missing]
        finally:
            subprocess.run(["umount", str(folder)], check=True)
    return point


def go_inside() -> None:
    """Goes on in a name space of mounts of its own, whose mounts go with it."""
    if not shutil.which("unshare"):
        raise SystemExit("full_disk needs the command unshare (Linux)")
    rights = [] if os.geteuid() == 0 else ["--map-root-user"]
    os.environ[INSIDE] = "yes"
    words = ["unshare", "--mount", *rights, sys.executable, str(RUN)]
    os.execvp(words[0], [*words, Path(__file__).stem, *sys.argv[1:]])


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20, help="points at which the disk is full (20)")
    parser.add_argument("--json", type=Path, help="write what came of each to this file")
    arguments = parser.parse_args()
    if INSIDE not in os.environ:
        go_inside()
    with tempfile.TemporaryDirectory() as scratch:
        started = time.monotonic()
        done = holdfast(Path(scratch))
        if done.returncode != 0:
            raise SystemExit(f"with room: exit code {done.returncode}: {done.stderr[-400:]}")
        expected, whole = run_result(Path(scratch)), taken_bytes(Path(scratch))
    print(f"with room: {whole // 1024} KiB, {time.monotonic() - started:.0f} s", flush=True)
    points: list[Point] = []
    for k in range(arguments.count):
        # Never nothing, which tmpfs takes for no bound.
        held = max(1, int((k + 0.5) / arguments.count * whole) // PAGE) * PAGE
        points.append(try_full(held, expected))
        if arguments.json:
            write_json(arguments.json, [asdict(point) for point in points])
        verdict = "; ".join(f"FAULT {fault}" for fault in points[-1].faults) or "equal after resume"
        print(
            f"{k + 1} of {arguments.count}: {held // 1024} KiB: {points[-1].said.strip()}: {verdict}",
            flush=True,
        )
    faults = sum(len(point.faults) for point in points)
    print(f"{len(points)} points, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    raise SystemExit(main())
