"""The table of a task file: read, watched by both libraries, and refused where it makes no sense."""

import numpy as np
import pytest
import yaml
from holdfast.errors import InputError
from holdfast.objects import load_task
from holdfast.retraction import compute_clearance, compute_clearance_by_mujoco
from holdfast.solver import State

TASK = {
    "name": "pick",
    "hand": "sa",
    "object": "scalpel",
    "contacts": [{"hand": "index/tip", "object": "index_grip"}],
}


def write(folder, support):
    path = folder / "pick.yaml"
    path.write_text(yaml.safe_dump({**TASK, "support": support}))
    return path


def test_table_of_a_task_file_is_watched(tmp_path):
    task = load_task(write(tmp_path, {"point": [0.0, 0.0, -0.02], "normal": [0, 0, 2]}))
    assert task.support is not None
    assert np.array_equal(task.support.point, [0.0, 0.0, -0.02])
    # Which pairs are watched does not depend on the state.
    q = 0.5 * task.limits.sum(axis=1)
    state = State(q, np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, -1.0]), np.full(4, 0.5))
    for measured in (compute_clearance, compute_clearance_by_mujoco):
        table = measured(task, state)
        watched = {pair.a for pair in table.pairs if pair.b == "support"}
        assert watched == {link.name for link in task.hand.links}
        assert not any(pair.intended for pair in table.pairs if pair.b == "support")


@pytest.mark.parametrize(
    ("support", "field"),
    [
        ({"point": [0, 0, 0]}, "normal"),
        ({"point": [0, 0, 0], "normal": [0, 0, 0]}, "normal"),
        ({"point": [0, 0], "normal": [0, 0, 1]}, "point"),
        ({"point": [0, 0, float("nan")], "normal": [0, 0, 1]}, "point"),
        ({"point": [0, 0, 0], "normal": [0, 0, 1], "friction": 0.5}, "friction"),
    ],
    ids=["no normal", "no direction", "two coordinates", "not a number", "unknown field"],
)
def test_bad_table_is_refused(tmp_path, support, field):
    with pytest.raises(InputError) as refused:
        load_task(write(tmp_path, support))
    assert "support" in str(refused.value) and field in str(refused.value)
