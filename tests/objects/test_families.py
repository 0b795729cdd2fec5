"""Members of the seeded families: valid objects, the same for a seed on every machine, and graspable."""

import hashlib
import inspect
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.objects import Task, load_object, load_task
from holdfast.objects.carrying import PLANNED_FRICTION, WANTED, contact_places, object_load
from holdfast.objects.families import FAMILIES, family_grasps
from holdfast.pipeline.cli.main import main
from holdfast.solver import solve

from .surface import distance_to_mesh, height_above, is_closed

MEMBERS = [f"family:{family}:{seed}" for family in FAMILIES for seed in (0, 1, 2, 17)]


def digest(name):
    obj = load_object(name)
    sha = hashlib.sha256(f"{obj.name} {obj.friction!r} {obj.inertia.mass!r}".encode())
    for part in obj.parts:
        for array in (
            part.mesh.vertices,
            part.mesh.faces,
            part.inertia.inertia,
            *(p.vertices for p in part.pieces),
        ):
            sha.update(np.ascontiguousarray(array).tobytes())
    for region in obj.regions.values():
        sha.update(region.patch.control_points.tobytes())
    return sha.hexdigest()


@pytest.mark.parametrize("name", MEMBERS)
def test_members_are_closed_and_their_regions_lie_on_them(name):
    obj = load_object(name)
    for part in obj.parts:
        assert is_closed(part.mesh)
        assert height_above(part.pieces, part.mesh.vertices).max() < 1e-9
    for region in obj.regions.values():
        points, normals = region.sample(40, np.random.default_rng(0))
        assert distance_to_mesh(obj.mesh, points).max() < 1e-4
        height = height_above(obj.pieces, points)
        assert height.min() > -1e-4
        assert height.max() < 1e-4
        assert height_above(obj.pieces, points + 1e-3 * normals).min() > 9e-4


@pytest.mark.parametrize("name", MEMBERS)
def test_members_can_be_held_by_a_hand(name):
    obj = load_object(name)
    assert 0.005 < obj.inertia.mass < 0.8
    assert 0.3 < obj.friction < 0.9
    assert obj.size_m < 0.4
    moments = np.linalg.eigvalsh(obj.inertia.inertia)
    assert moments[0] > 0
    assert moments[2] < moments[0] + moments[1]
    assert np.all(obj.inertia.centre > obj.mesh.bounds[0])
    assert np.all(obj.inertia.centre < obj.mesh.bounds[1])
    assert {"mass", "friction"} <= set(obj.sources)


@pytest.mark.parametrize("name", [f"family:{family}:17" for family in FAMILIES])
def test_tasks_of_members(name):
    task = load_task(name)
    assert task.object is load_object(name)
    assert task.name == task.object.name
    assert task.hand.name == "sa"
    assert len(task.contacts) >= 2
    for contact in task.contacts:
        assert task.object.regions[contact.object.name] is contact.object.region


def test_members_are_held_as_usual_unless_that_is_too_little():
    """Their contacts carry 1.5 times the weight with friction to spare."""
    for family in FAMILIES:
        for seed in range(4):
            name = f"family:{family}:{seed}"
            task, (usual, *stronger) = load_task(name), family_grasps(name)
            load = object_load(task.object)
            spared = replace(load, friction=PLANNED_FRICTION * load.friction)
            pairs = tuple((contact.hand.name, contact.object.name) for contact in task.contacts)
            assert pairs in (usual, *stronger)
            best = spared.multiple(spared.best(contact_places(task.contacts, task.hand), WANTED))
            assert best >= WANTED
            if pairs != usual:
                weak = Task(hand="sa", object=task.object, contacts=usual)
                assert (
                    spared.multiple(spared.best(contact_places(weak.contacts, weak.hand), polished=False))
                    < WANTED
                )


def test_mugs_are_hollow_where_bodies_collide():
    """A fingertip fits in, down to the bottom; the wall has its thickness at the rim."""
    for seed in (0, 17):
        mug = load_object(f"family:mug:{seed}")
        inside, outside = (
            mug.regions[f"rim_{side}"].patch.evaluate(0.5, 0.5) for side in ("inside", "outside")
        )
        wall = np.linalg.norm(outside - inside)
        assert 0.003 < wall < 0.0045
        assert height_above(mug.pieces, 0.5 * (inside + outside)[None])[0] < 1e-9
        up = np.linspace(2.0 * wall, inside[2], 5)
        axis = np.column_stack([0.0 * up, 0.0 * up, up])
        expected = np.minimum(up - up[0], abs(inside[0]))
        assert np.allclose(height_above(mug.pieces, axis), expected, atol=5e-4)


def test_a_hand_without_the_regions_of_stronger_grasps_takes_those_it_has():
    task = load_task("family:plate:34@ultralight")
    assert {contact.hand.name for contact in task.contacts} <= set(load_hand("ultralight").regions)


def test_seeds_differ_and_repeat_in_another_process():
    names = [f"family:{family}:{seed}" for family in FAMILIES for seed in (0, 1)]
    here = [digest(name) for name in names]
    assert len(set(here)) == len(here)
    script = (
        "import hashlib, numpy as np\nfrom holdfast.objects import load_object\n"
        + inspect.getsource(digest)
        + f"\nfor name in {names!r}:\n    print(digest(name))\n"
    )
    out = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert out.split() == here


def count_solved(family, seeds):
    tasks = [load_task(f"family:{family}:{seed}") for seed in seeds]
    return sum(bool(solve(task, candidates=1, budget_s=20).configurations) for task in tasks)


@pytest.mark.parametrize("family", FAMILIES)
def test_members_have_a_certified_grasp(family):
    assert count_solved(family, range(3)) == 3


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_most_members_have_a_certified_grasp(family):
    assert count_solved(family, range(20)) >= 16


@pytest.mark.parametrize("load", [load_object, load_task], ids=["object", "task"])
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("family:mgu:3", "did you mean 'mug'"),
        ("family:", "unknown family ''"),
        ("family:mug", "whole number"),
        ("family:mug:", "whole number"),
        ("family:mug:x", "family:mug:17"),
        ("family:mug:-1", "whole number"),
        ("family:mug:1.5", "whole number"),
        ("family:mug:٣", "whole number"),
        ("family:mug:9999999999", "whole number"),
        ("family:mug:1:2", "whole number"),
    ],
)
def test_bad_names(load, name, words):
    with pytest.raises(InputError, match=words):
        load(name)


def test_a_task_file_may_name_a_member(tmp_path):
    path = tmp_path / "task.yaml"
    path.write_text(
        "name: own\nhand: sa\nobject: family:box:3\ncontacts:\n"
        "  - {hand: index/pad, object: front}\n  - {hand: thumb/pad, object: back}\n"
    )
    assert load_task(path).object is load_object("family:box:3")


@pytest.mark.parametrize("kind", ["objects", "tasks"])
def test_the_command_line_lists_and_shows_them(kind, capsys):
    assert main([kind]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("family:"))
    listed = row.partition("families: ")[2].split(", ")
    assert listed == sorted(FAMILIES)
    assert main([kind, "family:mug:17"]) == 0
    shown = capsys.readouterr().out
    assert "mug_17" in shown
    assert "body_left" in shown
    assert main([kind, "family:mug"]) == 2
    assert "whole number" in capsys.readouterr().err
