import subprocess
import sys

import numpy as np
import pytest
from holdfast.base.machine.jit import compiled

SOURCE = """
def reciprocal(x):
    return 1.0 / x
"""


def test_what_cannot_be_cached_is_compiled_all_the_same():
    scope = {}
    exec(SOURCE, scope)  # code without a file has no place to keep its machine code
    assert compiled(scope["reciprocal"])(4.0) == pytest.approx(0.25)


def test_division_by_zero_is_that_of_numpy():
    scope = {}
    exec(SOURCE, scope)
    assert compiled(scope["reciprocal"])(0.0) == np.inf


def test_what_is_copied_into_its_callers_is_compiled_as_well():
    scope = {}
    exec(SOURCE, scope)
    assert compiled(scope["reciprocal"], inline=True)(4.0) == pytest.approx(0.25)


@pytest.mark.slow
def test_kept_code_is_renewed_with_what_it_calls_in_other_files(tmp_path):
    head = "from holdfast.base.machine.jit import compiled\n"
    (tmp_path / "middle.py").write_text(
        f"{head}from lowest import value\n@compiled\ndef twice():\n    return 2.0 * value()\n"
    )
    (tmp_path / "top.py").write_text(
        f"{head}from middle import twice\n@compiled\ndef one_more():\n    return 1.0 + twice()\n"
    )
    assert _ask(tmp_path, 3.0) == (7.0, 0.0)
    assert _ask(tmp_path, 3.0) == (7.0, 1.0)
    assert _ask(tmp_path, 5.0) == (11.0, 0.0)


@pytest.mark.parametrize("module", ["pairs", "couples"])
def test_kept_code_for_a_class_that_was_moved_or_renamed_is_compiled_anew(tmp_path, module):
    (tmp_path / "sums.py").write_text(
        "from holdfast.base.machine.jit import compiled\n"
        "@compiled\ndef total(pair):\n    return pair.a + pair.b\n"
    )
    for module_now, name in (("pairs", "Pair"), (module, "Couple")):
        (tmp_path / "pairs.py").unlink(missing_ok=True)
        (tmp_path / f"{module_now}.py").write_text(
            f"from typing import NamedTuple\nclass {name}(NamedTuple):\n    a: float\n    b: float\n"
        )
        ask = f"from sums import total; from {module_now} import {name}; print(total({name}(1.0, 2.0)))"
        run = subprocess.run([sys.executable, "-c", ask], cwd=tmp_path, capture_output=True, text=True)
        assert run.stdout == "3.0\n", run.stderr


def _ask(folder, number):
    """What the uppermost function says in a new process, and how often it was loaded, not compiled."""
    source = f"from holdfast.base.machine.jit import compiled\n@compiled\ndef value():\n    return {number}\n"
    if not (folder / "lowest.py").exists() or (folder / "lowest.py").read_text() != source:
        (folder / "lowest.py").write_text(source)
    ask = "from top import one_more; print(one_more(), sum(one_more.stats.cache_hits.values()))"
    run = subprocess.run([sys.executable, "-c", ask], cwd=folder, capture_output=True, text=True, check=True)
    said, loads = run.stdout.split()
    return float(said), float(loads)
