"""The law of bad input, and a process that each input is tried in."""

import json
import os
import random
import resource
import signal
import sys
import tempfile
import traceback
from importlib import import_module
from pathlib import Path
from typing import IO, NamedTuple

from holdfast.pipeline.cli import main

from .damage import damaged, put_instead
from .kinds import Kind

__all__ = ["broken_law", "try_good", "try_one", "warm_up"]

_CODES = (0, 2, 3, 4)
_LONGEST_S = 60
_MOST_BYTES = 2 * 1024**3
_LONGEST_LINE = 4000
# An exit code that no command has.
_STRANGE = 99


def warm_up() -> None:
    """Imports what commands import, so that no process has to do it anew."""
    os.environ.update(HOLDFAST_RENDERER="rays", MUJOCO_GL="disable")
    import_module("mujoco")
    for name in (
        "catalogue._details",
        "catalogue.hands_new",
        "catalogue.objects_fit",
        "data.export",
        "grasps.clear",
        "grasps.run",
        "grasps.suggest",
        "pictures.edit",
        "pictures.report",
        "pictures.show",
        "proofs.check_proof",
        "proofs.system",
    ):
        import_module(f"holdfast.pipeline.cli.commands.{name}")
    # Compiles the inner loops, where that has not been done yet.
    from holdfast.solver import solve_system

    solve_system([{((0, 1),): 1}], [-1.0], [2.0])


class Answer(NamedTuple):
    """What came of a command.

    Attributes:
        wrong: the law that it broke, or nothing.
        code: its exit code; None where it had none.
        said: on standard error.
    """

    wrong: str
    code: int | None = None
    said: str = ""


def try_good(kind: Kind, folder: Path) -> str:
    """Lets a command read its good input, in a fresh folder; why that was not accepted, or ''.

    Damage to an input that is refused anyway would test nothing.
    """
    _lay(kind, folder)
    answer = _answer(_words(kind), folder)
    if answer.wrong:
        return answer.wrong
    if answer.code not in kind.codes or kind.says not in answer.said:
        return f"the good input ends with exit code {answer.code}: {json.dumps(answer.said[:300])}"
    return ""


def try_one(kind: Kind, folder: Path, seed: int, *, anew: bool = False) -> str:
    """Damages a good input and lets its command read it, in a fresh folder; what law that broke, or ''.

    Args:
        kind: of the input.
        folder: an empty one.
        seed: of the damage.
        anew: whether the command is started as a user starts it; else this process is forked, which saves
            it the imports.
    """
    rng = random.Random(seed)
    _lay(kind, folder)
    path = folder / kind.name
    if rng.random() < 0.08:
        put_instead(path, rng)
    else:
        path.write_bytes(damaged(kind.good, rng))
    before = _names(folder)
    wrong = _answer(_words(kind), folder, anew=anew).wrong
    allowed = {folder / "run" / "report.html", path}
    new = {name for name in _names(folder) - before - allowed if _first(name, folder) not in kind.makes}
    if not wrong and new:
        wrong = f"left {sorted(new)[0].name}"
    return wrong


def broken_law(words: list[str], folder: Path) -> str:
    """Runs a command in a process of its own, in a folder; which law it broke, or nothing."""
    return _answer(words, folder).wrong


def _lay(kind: Kind, folder: Path) -> None:
    for name, data in (*kind.beside, (kind.name, kind.good)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


def _words(kind: Kind) -> list[str]:
    return [word.replace("{}", kind.name) for word in kind.words]


def _first(path: Path, folder: Path) -> str:
    return path.relative_to(folder).parts[0]


def _names(folder: Path) -> set[Path]:
    return set(folder.rglob("*"))


def _answer(words: list[str], folder: Path, *, anew: bool = False) -> Answer:
    """Runs a command in a folder: in a fork of this process, or `anew` as a user starts it."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            code = _STRANGE
            try:
                os.chdir(folder)
                for stream, number in ((out, 1), (err, 2)):
                    os.dup2(stream.fileno(), number)
                _bound()
                if anew:
                    os.execv(sys.executable, [sys.executable, "-P", "-m", "holdfast", *words])
                code = _main(words)
            finally:
                os._exit(code)
        _, status, usage = os.wait4(child, 0)
        printed, said = (_text(stream) for stream in (out, err))
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return Answer("hangs" if number == signal.SIGALRM else f"ends by signal {number}", None, said)
    code = os.WEXITSTATUS(status)
    if usage.ru_maxrss * 1024 > _MOST_BYTES:
        return Answer(f"takes {usage.ru_maxrss // 1024} MiB", code, said)
    return Answer(_wrong(code, said, printed), code, said)


def _text(stream: IO[bytes]) -> str:
    stream.seek(0)
    return stream.read().decode("utf-8", "replace")


def _bound() -> None:
    """Bounds the time and the address space of this process."""
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(_LONGEST_S)
    resource.setrlimit(resource.RLIMIT_AS, (8 * 1024**3, resource.getrlimit(resource.RLIMIT_AS)[1]))


def _main(words: list[str]) -> int:
    """The command in this process, a fork; what comes out of it but an exit code is said."""
    # A good input would be served by the editor until Ctrl-C; without viser it says so once all is read.
    sys.modules["viser"] = None  # type: ignore[assignment]
    # What this process had for them may be a test's own.
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    try:
        return main(words)
    except BaseException:  # noqa: BLE001  anything that comes out is a violation
        sys.stderr.write(traceback.format_exc())
        return _STRANGE
    finally:
        sys.stdout.flush()
        sys.stderr.flush()


def _wrong(code: int, said: str, printed: str) -> str:
    if code not in _CODES:
        return f"exit code {code}: {json.dumps(said[-300:])}"
    # What is odd but no error has lines of its own before it.
    errors = [line for line in said.splitlines() if not line.startswith("holdfast: warning: ")]
    if code == 2 and (len(errors) != 1 or not said.splitlines()[-1].startswith("holdfast: ") or printed):
        return f"exit code 2 without one line: {json.dumps(said[:300])} {json.dumps(printed[:100])}"
    if "Traceback" in said or "out of memory" in said:
        return f"says {json.dumps(said[:300])}"
    if len(said) > _LONGEST_LINE:
        return f"says {len(said)} characters"
    if any(not c.isprintable() and c != "\n" for c in said + printed):
        return f"prints control characters: {json.dumps((said + printed)[:300])}"
    return ""
