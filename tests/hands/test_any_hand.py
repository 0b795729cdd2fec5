"""One two-contact task with many hands, and a hand with a joint of every kind, through the whole chain."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import yaml
from holdfast.hands import builtin_hands, load_hand
from holdfast.mjcf import hand_mjcf
from holdfast.objects import load_task
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.records import read_run
from holdfast.pipeline.run import RunSettings, run_task
from holdfast.solver import State, solve
from holdfast.solver.formulate.formulate import formulate

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "hands"
PINCH = EXAMPLES / "pinch.yaml"
SERVO = {"effort": 3.0, "stiffness": 30.0, "damping": 0.4, "armature": 0.002}
JAW = {"effort": 40.0, "stiffness": 2000.0, "damping": 20.0, "armature": 0.01}


def finger(name: str, y: float, ratio: str | float) -> tuple[list, list]:
    """A slide, a universal joint, a fixed link, two joints that follow; the pad faces the palm's middle."""
    links = [f"{name}_{part}" for part in ("carriage", "proximal", "wedge", "medial", "distal")]
    side = -1.0 if y > 0 else 1.0
    capsule = [{"capsule": {"start": [0, 0, 0], "end": [0, 0, 0.04], "radius": 0.008}}]
    ball = [{"sphere": {"centre": [0, 0, 0], "radius": 0.008}}]
    bend = [side, 0.0, 0.0]

    def joint(kind, child, parent, position, *axes):
        return {"type": kind, "parent": parent, "child": child, "position": position, "axes": list(axes)}

    joints = [
        joint("prismatic", links[0], "palm", [0, y, 0.03],
              {"name": f"{name}_slide", "direction": [0, side, 0], "limits": [0, 0.02], "actuator": JAW}),
        joint("universal", links[1], links[0], [0, 0, 0.01],
              {"name": f"{name}_spread", "direction": [0, 1, 0], "limits_deg": [-20, 20], "actuator": SERVO},
              {"name": f"{name}_bend", "direction": bend, "limits_deg": [-60, 60], "actuator": SERVO}),
        joint("fixed", links[2], links[1], [0, 0, 0.04]),
        joint("revolute", links[3], links[2], [0, 0, 0.002],
              {"name": f"{name}_pip", "direction": bend, "limits_deg": [-80, 80],
               "coupled": {"to": f"{name}_bend", "ratio": ratio, "offset_deg": -5}}),
        joint("revolute", links[4], links[3], [0, 0, 0.04],
              {"name": f"{name}_dip", "direction": bend, "limits_deg": [-80, 80],
               "coupled": {"to": f"{name}_pip", "ratio": 0.5}}),
    ]  # fmt: skip
    shapes = [ball, capsule, ball, capsule, capsule]
    return [{"name": n, "mass": 0.03, "shapes": s} for n, s in zip(links, shapes, strict=True)], joints


def every_kind(ratio: str | float) -> dict:
    """A hand of two such fingers."""
    left, right = finger("index", 0.04, ratio), finger("thumb", -0.04, ratio)
    palm = {
        "name": "palm",
        "mass": 0.3,
        "shapes": [{"box": {"centre": [0, 0, 0], "half_extents": [0.03, 0.06, 0.01]}}],
    }
    tip = {"centre": [0, 0, 0.04], "radius": 0.008, "half_angle_deg": 60}
    return {
        "name": "kinds",
        "links": [palm, *left[0], *right[0]],
        "joints": left[1] + right[1],
        "regions": {
            "index/tip": {"link": "index_distal", "cap": {**tip, "axis": [0, -1, 0.6]}},
            "thumb/tip": {"link": "thumb_distal", "cap": {**tip, "axis": [0, 1, 0.6]}},
        },
    }


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


@pytest.fixture(scope="module")
def kinds(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("kinds") / "kinds.yaml"
    path.write_text(yaml.dump(every_kind("2/3"), Dumper=WrittenOut), "utf-8")
    return path


def solved(hand: str | Path, count: int = 2) -> None:
    task = load_task(f"{PINCH}@{hand}")
    result = solve(task, candidates=count, budget_s=600.0)
    assert result.verdict.value == "solved"
    assert len(result.configurations) == count
    for configuration in result.configurations:
        assert configuration.certified
        assert max(abs(point.gap_m) for point in configuration.contact_points) < 1e-9
        q = configuration.state.q
        assert np.all((task.limits[:, 0] - 1e-9 <= q) & (q <= task.limits[:, 1] + 1e-9))


@pytest.mark.parametrize("name", builtin_hands())
def test_built_in_hands_solve_the_task(name):
    solved(name)


@pytest.mark.parametrize("name", ["allegro", "leap"])
def test_public_hands_solve_the_task(public_hands, name):
    solved(public_hands[name])


def test_a_hand_with_every_kind_of_joint_solves_the_task(kinds):
    solved(kinds)


def test_states_pass_through_the_unknowns_of_the_system(kinds):
    """Angles of which others turn by a fraction stand in the system divided, and come back whole."""
    task = load_task(f"{PINCH}@{kinds}")
    formulation = formulate(task)
    names = load_hand(kinds).independent_names
    thirds = {names[j] for j, divisor in formulation.divisors.items() if divisor == 3}
    assert thirds == {"index_bend", "thumb_bend"}
    assert set(formulation.divisors.values()) == {1, 3}
    rng = np.random.default_rng(2)
    n_params = len(formulation.param_inputs)
    for _ in range(20):
        q = rng.uniform(*task.limits.T)
        state = State(q, np.eye(3), rng.uniform(-0.1, 0.1, 3), rng.uniform(size=n_params))
        back = formulation.state_from_inputs(formulation.inputs_from_state(state), np.zeros(len(q)))
        assert back.q == pytest.approx(q, abs=1e-13)


def test_couplings_hold_in_the_model_of_a_hand_with_every_kind_of_joint(kinds):
    hand = load_hand(kinds)
    model = mujoco.MjModel.from_xml_string(hand_mjcf(hand))
    data = mujoco.MjData(model)
    assert (model.njnt, model.neq, model.nu) == (10, 4, 6)
    rng = np.random.default_rng(0)
    for _ in range(10):
        for name, q in zip(hand.joint_names, hand.expand(rng.uniform(*hand.limits.T)), strict=True):
            data.joint(name).qpos[0] = q
        mujoco.mj_forward(model, data)
        violation = data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]
        assert len(violation) == 4
        assert np.abs(violation).max() < 1e-12


def test_a_ratio_that_is_no_fraction_is_solved_like_any_other(tmp_path):
    path = tmp_path / "kinds.yaml"
    path.write_text(yaml.dump(every_kind(0.7777), Dumper=WrittenOut), "utf-8")
    solved(path)


@pytest.fixture
def without_pictures(monkeypatch) -> None:
    monkeypatch.setattr("holdfast.pipeline.report.drawing.draw_grasps", lambda *_, **__: (one for one in ()))
    monkeypatch.setenv("HOLDFAST_RENDERER", "rays")
    monkeypatch.setenv("MUJOCO_GL", "disable")


def held(hand: str | Path, folder: Path) -> None:
    record = run_task(f"{PINCH}@{hand}", folder, RunSettings(candidates=4, wanted=1, budget_s=600.0))
    assert record.verdict == "held"
    assert record.good and record.hand == load_hand(hand).name


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sa", "shadow", "dist", "robonaut", "ultralight"])
def test_built_in_hands_hold_the_can(without_pictures, tmp_path, name):
    held(name, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["allegro", "leap"])
def test_public_hands_hold_the_can(without_pictures, public_hands, tmp_path, name):
    held(public_hands[name], tmp_path)


@pytest.mark.slow
def test_a_hand_with_every_kind_of_joint_holds_the_can(without_pictures, kinds, tmp_path):
    held(kinds, tmp_path)


@pytest.mark.slow
def test_the_option_puts_a_hand_in_place_and_later_stages_remember(without_pictures, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["run", str(PINCH), "--hand", "shadow", "--candidates", "2", "--quiet"]) == 0
    record = read_run(tmp_path / "runs" / "pinch_shadow" / "run.json")
    assert record.hand == "shadow"
    grasp = tmp_path / "runs" / "pinch_shadow" / "grasps" / f"{record.good[0].id}.json"
    assert main(["clear", str(grasp)]) == 0


def test_the_option_refuses_what_is_no_hand(capsys):
    assert main(["solve", str(PINCH), "--hand", "shadwo"]) == 2
    assert "did you mean 'shadow'?" in capsys.readouterr().err
