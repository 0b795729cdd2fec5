"""Checkpoints: a search that was left, or killed, goes on as if it had never stopped."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.objects import Task, load_task
from holdfast.solver import SearchOrder, SolveResult, TaskSearch, Verdict, iterate, solve
from holdfast.solver.search import checkpoint as checkpoint_module

DEADLINE_S = 120.0


def arrays_of(result: SolveResult) -> list[bytes]:
    out = []
    for c in result.configurations:
        assert c.certificate is not None
        state, proof = c.state, c.certificate
        arrays = [state.q, state.R_palm_object, state.p_palm_object, state.params, proof.lower, proof.upper]
        out += [a.tobytes() for a in arrays] + [repr((c.residual_m, proof.fixed, proof.names)).encode()]
    return out


def counts_of(result: SolveResult) -> tuple[object, ...]:
    return result.verdict, result.boxes, result.open, result.undecided, result.lps


def run_steps(steps: Iterator[TaskSearch], count: int) -> TaskSearch:
    """Takes so many steps and leaves the search."""
    for _, search in zip(range(count), steps, strict=False):
        last = search
    steps.close()  # type: ignore[attr-defined]
    return last


@pytest.mark.parametrize("steps", [1, 2, 30])
def test_a_search_that_was_left_goes_on_to_the_same_configurations(
    upholding: Task, tmp_path: Path, steps: int
) -> None:
    whole = solve(upholding, candidates=60, seed=5)
    path = tmp_path / "search.checkpoint"
    left = run_steps(iterate(upholding, seed=5, checkpoint=path), steps)
    assert 0 < len(left.state.solutions) < 60
    resumed = solve(upholding, candidates=60, seed=5, checkpoint=path, resume=True)
    assert counts_of(resumed) == counts_of(whole)
    assert arrays_of(resumed) == arrays_of(whole)
    # What is found already is not looked for again.
    again = solve(upholding, candidates=60, seed=5, checkpoint=path, resume=True)
    assert counts_of(again) == counts_of(whole)
    assert arrays_of(again) == arrays_of(whole)


@pytest.mark.parametrize("order", SearchOrder)
def test_a_refutation_that_was_left_twice_ends_with_the_same_tree(
    make_plate_task: Callable[[float], Task], tmp_path: Path, order: SearchOrder
) -> None:
    task, path = make_plate_task(0.106), tmp_path / "search.checkpoint"
    whole = solve(task, order=order)
    assert whole.boxes > 5
    for resume in (False, True):
        left = run_steps(iterate(task, order=order, checkpoint=path, resume=resume), 2)
        assert left.state.n_open > 0
    resumed = solve(task, order=order, checkpoint=path, resume=True, workers=2)
    assert counts_of(resumed) == counts_of(whole)
    assert resumed.verdict is Verdict.INFEASIBLE


SCRIPT = """
import sys
from holdfast.objects import load_task
from holdfast.solver import iterate
for search in iterate(load_task("upholding"), seed=8, checkpoint=sys.argv[1], workers=int(sys.argv[2])):
    if search.state.processed > 10_000:
        break
"""


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_a_search_that_is_killed_goes_on_from_its_last_checkpoint(
    upholding: Task, tmp_path: Path, workers: int
) -> None:
    path = tmp_path / "search.checkpoint"
    process = subprocess.Popen([sys.executable, "-c", SCRIPT, str(path), str(workers)])
    first = wait_for(path.exists) and path.stat().st_mtime_ns
    wait_for(lambda: path.stat().st_mtime_ns > first)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    found = iterate(upholding, seed=8, checkpoint=path, resume=True)
    reached = len(run_steps(found, 1).state.solutions)
    assert reached > 1
    resumed = solve(upholding, candidates=reached + 20, seed=8, checkpoint=path, resume=True)
    assert arrays_of(resumed) == arrays_of(solve(upholding, candidates=reached + 20, seed=8))


def wait_for(condition: Callable[[], bool]) -> bool:
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)
    return True


def test_a_checkpoint_is_not_written_over_by_a_new_search(upholding: Task, tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    solve(upholding, candidates=1, checkpoint=path)
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"search\.checkpoint.*exists; resume it"):
        solve(upholding, candidates=1, checkpoint=path)
    assert path.read_bytes() == before


def test_resuming_without_a_file_begins_anew(upholding: Task, tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    result = solve(upholding, candidates=2, checkpoint=path, resume=True)
    assert arrays_of(result) == arrays_of(solve(upholding, candidates=2))
    assert path.exists()


CHANGES = {
    "seed": {"seed": 1},
    "sigma": {"sigma": 0.2},
    "pure": {"pure": True},
    "order": {"order": SearchOrder.BEST_FIRST},
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_checkpoint_of_other_settings_is_refused(upholding: Task, tmp_path: Path, change: str) -> None:
    path = tmp_path / "search.checkpoint"
    solve(upholding, candidates=1, checkpoint=path)
    with pytest.raises(InputError, match="another task, other settings"):
        solve(upholding, candidates=1, checkpoint=path, resume=True, **CHANGES[change])


def test_a_checkpoint_of_another_task_is_refused(
    upholding: Task, make_plate_task: Callable[[float], Task], tmp_path: Path
) -> None:
    path = tmp_path / "search.checkpoint"
    solve(upholding, candidates=1, checkpoint=path)
    with pytest.raises(InputError, match="another task, other settings"):
        solve(make_plate_task(0.01), candidates=1, checkpoint=path, resume=True)
    # The same task, loaded anew, is the same.
    assert solve(load_task("upholding"), candidates=1, checkpoint=path, resume=True).boxes == 1


def test_a_damaged_checkpoint_is_refused(upholding: Task, tmp_path: Path) -> None:
    path = tmp_path / "search.checkpoint"
    solve(upholding, candidates=3, checkpoint=path)
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    damaged = [b"", b"{}", whole[:-1], whole[: len(whole) // 2], whole + b"x"]
    places = rng.integers(len(whole), size=20)
    damaged += [whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :] for place in places]
    for data in damaged:
        path.write_bytes(data)
        with pytest.raises(InputError, match=r"search\.checkpoint"):
            solve(upholding, candidates=3, checkpoint=path, resume=True)


def test_a_checkpoint_that_can_not_be_written_is_an_error_before_the_search(
    upholding: Task, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="file"):
        solve(upholding, checkpoint=tmp_path / "file" / "search.checkpoint")


def test_a_proof_and_a_checkpoint_can_not_be_had_together(upholding: Task, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="proof"):
        solve(upholding, proof=tmp_path / "no.proof", checkpoint=tmp_path / "search.checkpoint")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("change", ["nan", "wider", "turned", "other shape"])
def test_boxes_that_are_no_part_of_the_search_are_refused(
    make_plate_task: Callable[[float], Task], tmp_path: Path, change: str
) -> None:
    """With a right checksum, as from another program: a search would go on with them to a wrong answer."""
    task, path = make_plate_task(0.106), tmp_path / "search.checkpoint"
    run_steps(iterate(task, checkpoint=path), 2)
    key, snapshot = checkpoint_module._read(path)
    name = next(n for n in ("frontier.lower", "undecided.lower", "ahead.lower") if n in snapshot.arrays)
    lower = snapshot.arrays[name]
    if change == "nan":
        lower[0, 0] = np.nan
    elif change == "wider":
        lower[0, 0] -= 10.0
    elif change == "turned":
        lower[0, 0] = snapshot.arrays[name.replace("lower", "upper")][0, 0] + 1.0
    else:
        snapshot.arrays[name] = lower[:, :-1]
    checkpoint_module._write(path, key, snapshot)
    with pytest.raises(InputError, match="holds no search"):
        solve(task, checkpoint=path, resume=True)
