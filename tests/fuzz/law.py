"""The law of bad input, and a process that each input is tried in."""

import contextlib
import io
import json
import os
import random
import resource
import signal
import sys
import traceback
from importlib import import_module
from pathlib import Path

from holdfast.pipeline.cli import main

from .damage import damaged, put_instead
from .kinds import Kind

__all__ = ["broken_law", "try_one", "warm_up"]

_CODES = (0, 2, 3, 4)
_LONGEST_S = 60
_MOST_BYTES = 2 * 1024**3
_LONGEST_LINE = 4000


def warm_up() -> None:
    """Imports what commands import, so that no process has to do it anew."""
    os.environ.update(HOLDFAST_RENDERER="rays", MUJOCO_GL="disable")
    import_module("mujoco")
    for name in (
        "check_proof",
        "clear",
        "edit",
        "hands_new",
        "objects_fit",
        "report",
        "run",
        "show",
        "suggest",
        "system",
        "_details",
    ):
        import_module(f"holdfast.pipeline.cli.commands.{name}")
    # Compiles the inner loops, where that has not been done yet.
    from holdfast.solver import solve_system

    solve_system([{((0, 1),): 1}], [-1.0], [2.0])


def try_one(kind: Kind, folder: Path, seed: int) -> str:
    """Damages a good input and lets its command read it, in a fresh folder; what law that broke, or ''."""
    rng = random.Random(seed)
    for name, data in (*kind.beside, (kind.name, kind.good)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    path = folder / kind.name
    if rng.random() < 0.08:
        put_instead(path, rng)
    else:
        path.write_bytes(damaged(kind.good, rng))
    before = _names(folder)
    words = [word.replace("{}", kind.name) for word in kind.words]
    wrong = broken_law(words, folder)
    allowed = {folder / "run" / "report.html", path}
    new = {name for name in _names(folder) - before - allowed if _first(name, folder) not in kind.makes}
    if not wrong and new:
        wrong = f"left {sorted(new)[0].name}"
    return wrong


def _first(path: Path, folder: Path) -> str:
    return path.relative_to(folder).parts[0]


def _names(folder: Path) -> set[Path]:
    return set(folder.rglob("*"))


def broken_law(words: list[str], folder: Path) -> str:
    """Runs a command in a process of its own, in a folder; which law it broke, or nothing."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        verdict = "died"
        try:
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.alarm(_LONGEST_S)
            verdict = _judge(words, folder)
        finally:
            os.write(writing, verdict.encode("utf-8", "replace")[:60000])
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        verdict = pipe.read().decode("utf-8", "replace")
    _, status, usage = os.wait4(child, 0)
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return "hangs" if number == signal.SIGALRM else f"ends by signal {number}"
    if usage.ru_maxrss * 1024 > _MOST_BYTES:
        return f"takes {usage.ru_maxrss // 1024} MiB"
    return verdict


def _judge(words: list[str], folder: Path) -> str:
    os.chdir(folder)
    room = resource.getrlimit(resource.RLIMIT_AS)[1]
    # A good input would be served by the editor until Ctrl-C; without viser it says so once all is read.
    sys.modules["viser"] = None  # type: ignore[assignment]
    resource.setrlimit(resource.RLIMIT_AS, (8 * 1024**3, room))
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(words)
    except BaseException:  # noqa: BLE001  anything that comes out is a violation
        return "raises " + " | ".join(traceback.format_exc().splitlines()[-6:])
    said, printed = err.getvalue(), out.getvalue()
    return _wrong(code, said, printed)


def _wrong(code: int, said: str, printed: str) -> str:
    if code not in _CODES:
        return f"exit code {code}"
    if code == 2 and (not said.startswith("holdfast: ") or said.count("\n") != 1 or printed):
        return f"exit code 2 without one line: {json.dumps(said[:300])} {json.dumps(printed[:100])}"
    if "Traceback" in said or "out of memory" in said:
        return f"says {json.dumps(said[:300])}"
    if len(said) > _LONGEST_LINE:
        return f"says {len(said)} characters"
    if any(not c.isprintable() and c != "\n" for c in said + printed):
        return f"prints control characters: {json.dumps((said + printed)[:300])}"
    return ""
