"""Signals: a command ends soon, keeps what it has, leaves no process, and is not fooled by who sends them."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from holdfast.pipeline.cli.interrupt import answered_by, interrupting, stop_on_interrupt
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import read_run

from ..conftest import environment_for_subprocess

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]


@pytest.fixture(autouse=True)
def none_ignored() -> Iterator[None]:
    """The tests themselves may run under `nohup`, and what is ignored stays ignored."""
    before = {number: signal.getsignal(number) for number in SIGNALS}
    for number, handler in before.items():
        if handler is signal.SIG_IGN:
            signal.signal(number, signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@contextmanager
def command(*words: str, **options: object) -> Iterator["subprocess.Popen[str]"]:
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", "holdfast", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment_for_subprocess(),
        **options,  # type: ignore[call-overload]
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("number", SIGNALS)
def test_the_first_signal_is_a_wish_and_the_second_an_end(number: int) -> None:
    said: list[str] = []
    with pytest.raises(KeyboardInterrupt), interrupting(), stop_on_interrupt(said.append) as should_stop:
        assert not should_stop()
        os.kill(os.getpid(), number)
        assert should_stop() and len(said) == 1
        os.kill(os.getpid(), number)
        pytest.fail("the second signal should have raised")


def test_handlers_of_the_caller_come_back() -> None:
    before = [signal.getsignal(number) for number in SIGNALS]
    with interrupting(), stop_on_interrupt(lambda _: None):
        assert [signal.getsignal(number) for number in SIGNALS] != before
    assert [signal.getsignal(number) for number in SIGNALS] == before
    main(["tasks"])
    assert [signal.getsignal(number) for number in SIGNALS] == before


def test_what_is_ignored_stays_ignored() -> None:
    heard: list[int] = []
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with answered_by(lambda number, frame: heard.append(number)):
            os.kill(os.getpid(), signal.SIGHUP)
            os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGHUP, before)
    assert heard == [signal.SIGTERM]


def test_an_interrupt_that_a_library_swallows_ends_the_process_all_the_same() -> None:
    program = (
        "import os, signal, time\n"
        "from holdfast.pipeline.cli.interrupt import interrupting\n"
        "with interrupting():\n"
        "    try:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "    except KeyboardInterrupt:\n"
        "        pass\n"
        "    time.sleep(600)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], timeout=60, check=False)
    assert done.returncode == 130


@pytest.mark.parametrize("inner", [False, True])
def test_an_interrupt_that_compiled_code_makes_another_exception_of_stays_one(inner: bool) -> None:
    """As numba does, where the signal comes between its work and its answer."""
    with pytest.raises(KeyboardInterrupt), interrupting(), contextlib.ExitStack() as within:
        if inner:
            within.enter_context(stop_on_interrupt(lambda _: None))
            os.kill(os.getpid(), signal.SIGTERM)
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except KeyboardInterrupt as error:
            raise SystemError("returned a result with an exception set") from error
        pytest.fail("the signal should have raised")


def test_other_exceptions_are_not_taken_for_an_interrupt() -> None:
    with pytest.raises(SystemError), interrupting(), stop_on_interrupt(lambda _: None):
        raise SystemError


def test_an_interrupt_during_the_imports_is_heard() -> None:
    """The signal comes from the import of a library that would swallow an exception."""
    program = (
        "import os, signal, sys\n"
        "class Interrupting:\n"
        "    def find_spec(self, name, path, target=None):\n"
        "        if name == 'argparse':\n"
        "            try:\n"
        "                os.kill(os.getpid(), signal.SIGINT)\n"
        "            except BaseException:\n"
        "                pass\n"
        "sys.meta_path.insert(0, Interrupting())\n"
        "from holdfast.pipeline.cli import main\n"
        "sys.exit(main(['tasks']))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_run_that_is_told_to_end_keeps_what_it_has_and_leaves_no_process(
    number: int, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    words = ("run", "upholding", "--candidates", "8", "--workers", "2", "--out", str(out))
    with command(*words, start_new_session=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if "of them to be tried" in line:
                break
        time.sleep(1.0)  # the processes are starting, or at work
        process.send_signal(number)
        said, err = process.communicate(timeout=60)  # whoever holds the pipes is gone, too
    assert process.returncode == 130, err
    assert "Traceback" not in err and "incomplete, continue with --resume" in said
    assert not read_run(out / "run.json").complete
    assert not [path for path in out.rglob(".*") if path.is_file()]
