"""Standard output of compiled code, and of Python around it."""

import os
import subprocess
import sys

PROGRAM = """
import ctypes, os, sys
from holdfast.base.machine.native_output import native_stdout_dropped
libc = ctypes.CDLL(None)
print("one")
libc.puts(b"before")
with native_stdout_dropped():
    libc.puts(b"buffered by C")
    os.write(1, b"written at once\\n")
print("two", flush=True)
libc.puts(b"after")
"""


def output_of(program: str, **options: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(  # type: ignore[call-overload, no-any-return]
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, **options
    )


def test_what_compiled_code_prints_within_is_gone_and_nothing_else() -> None:
    done = output_of(PROGRAM)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n") == ["one", "before", "two", "after", ""]


def test_a_closed_standard_output_is_left_closed() -> None:
    program = (
        "from holdfast.base.machine.native_output import native_stdout_dropped\n"
        "with native_stdout_dropped():\n    pass\n"
    )
    assert output_of(program, preexec_fn=lambda: os.close(1)).returncode == 0


def test_a_linear_program_prints_nothing() -> None:
    """Newer versions of HiGHS greet whoever makes their first instance."""
    done = output_of("from holdfast.solver.linear.highs import LinearProgram; LinearProgram(3)")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
