"""Suggested contacts: force closure by another measure, files that load, and clear words for misuse."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from holdfast.base.machine.cancellation import give_up_if_asked
from holdfast.geometry import BezierPatch, Cap, Hull, Patch, PointRegion
from holdfast.geometry.solids import solid_inertia
from holdfast.hands import Hand, load_hand
from holdfast.objects import ObjectModel, Part, Task, load_object, load_task
from holdfast.pipeline.cli.main import main
from holdfast.pipeline.suggest import Site, Suggestion, Tried, searches, suggest
from holdfast.pipeline.suggest.askew import askew_rad
from holdfast.pipeline.suggest.cover import are_covered
from holdfast.pipeline.suggest.outcome import Outcome
from holdfast.pipeline.suggest.screen import PairLimits, can_ever_carry, screen
from holdfast.pipeline.suggest.surface import edge_sites, named_sites, surface_sites
from holdfast.pipeline.suggest.width import Widths
from holdfast.retraction import compute_clearance
from holdfast.solver import ContactManifold, Verdict, certify_state, solve
from scipy.optimize import linprog

BOX = """
name: box
box: {half_extents: [0.02, 0.03, 0.01]}
mass: 0.1
friction: 0.6
regions:
  front: {bezier: [[[-0.01, -0.01, 0.01], [-0.01, 0.01, 0.01]], [[0.01, -0.01, 0.01], [0.01, 0.01, 0.01]]]}
"""


@pytest.fixture
def box(tmp_path: Path) -> Path:
    path = tmp_path / "box.yaml"
    path.write_text(BOX, "utf-8")
    return path


@pytest.fixture(scope="module")
def suggestions(tmp_path_factory: pytest.TempPathFactory) -> list[Suggestion]:
    path = tmp_path_factory.mktemp("box") / "box.yaml"
    path.write_text(BOX, "utf-8")
    return suggest(load_hand("sa"), load_object(path), count=2, budget_s=600.0)


def sites(obj: ObjectModel) -> list[Site]:
    return named_sites(obj) + surface_sites(obj, 96, 0)[0]


def test_sites_lie_on_the_surface_and_look_outward(box: Path) -> None:
    obj = load_object(box)
    places = sites(obj)
    assert places[0].name == "front"
    assert len(places) == 97
    half = np.array([0.02, 0.03, 0.01])
    for site in places:
        # Height above each pair of faces: the largest is that of the face that the point lies on.
        heights = np.abs(site.point) - half
        k = int(np.argmax(heights))
        assert abs(heights[k]) < 3e-4
        assert np.sign(site.point[k]) * site.normal[k] > np.cos(np.radians(15.0))


def test_what_friction_can_hold_is_opposed(box: Path) -> None:
    obj = load_object(box)
    found = screen(load_hand("sa"), obj, sites(obj), 2, 20, 0)
    assert found
    angle = np.arctan(obj.friction)
    for combination in found:
        a, b = combination.sites
        line = (b.point - a.point) / np.linalg.norm(b.point - a.point)
        # Two contacts have force closure where the line between them lies in both cones (Nguyen 1988).
        assert -a.normal @ line > np.cos(angle)
        assert b.normal @ line > np.cos(angle)


def test_nothing_wider_than_the_hand_is_combined(box: Path) -> None:
    obj = load_object(box)
    found = screen(load_hand("sa"), obj, sites(obj), 2, 20, 0, limits=[PairLimits(0.045)])
    assert found
    for combination in found:
        a, b = combination.sites
        assert min(abs((b.point - a.point) @ n) for n in (a.normal, b.normal)) <= 0.045


@pytest.fixture
def jaw(tmp_path: Path) -> Hand:
    jaws = "".join(
        f"""<body name="{name}" pos="{x} 0 0.05"><joint name="{name}_slide" type="slide" axis="1 0 0"
        range="-0.02 0.02"/><geom type="box" size="0.005 0.01 0.03" mass="0.03"/></body>"""
        for name, x in (("left", 0.03), ("right", -0.03))
    )
    (tmp_path / "jaw.xml").write_text(
        f"""<mujoco><worldbody><body name="palm"><geom type="box" size="0.05 0.03 0.01" mass="0.3"/>{jaws}
        </body></worldbody></mujoco>""",
        "utf-8",
    )
    return load_hand(tmp_path / "jaw.xml")


def test_the_width_of_a_jaw_is_its_opening_and_of_many_joints_unknown(jaw: Hand) -> None:
    hand = jaw
    pads = [hand.regions[name] for name in ("left/pad", "right/pad")]
    # Both slid outwards, less the jaws' own thickness.
    assert Widths(hand, pads).widest_m(pads) == pytest.approx(0.06 + 0.04 - 0.01, abs=5e-4)
    assert Widths(hand, pads).are_parallel(pads) and Widths(hand, pads).askew_rad(pads) < 1e-3
    many = load_hand("sa")
    tips = [many.regions[name] for name in ("index/tip", "thumb/tip")]
    assert Widths(many, tips).widest_m(tips) == np.inf
    assert Widths(many, tips).askew_rad(tips) == pytest.approx(np.pi)


def test_a_jaw_that_opens_too_little_is_told_so(jaw: Hand, tmp_path: Path) -> None:
    """What a pad and the palm could have between them, far askew, is no opening of the jaw."""
    trimesh.creation.cylinder(0.06, 0.1, sections=64).export(tmp_path / "can.stl")
    search = searches(jaw, load_object(tmp_path / "can.stl", friction=0.8), 2)[0]
    assert not search.can_carry()
    assert search.tried.combinations == 0
    assert "the hand opens to 90 mm, and places that carry it are 100 mm apart" in search.tried.remedy


def test_what_is_askew_is_left_to_hands_that_bend(tmp_path: Path) -> None:
    """Sides of a cone are 40 degrees askew, and its ends are none; a can has no such trouble."""
    half = np.radians(20.0)
    cone = trimesh.creation.cone(0.06 * np.tan(half), 0.06, sections=64)
    cone.export(tmp_path / "cone.stl")
    obj = load_object(tmp_path / "cone.stl", friction=0.6)
    # Without the base, and without patches that wrap the point of the cone.
    places = [s for s in surface_sites(obj, 96, 0)[0] if s.normal[2] > -0.9 and s.bend_rad < 0.3]
    loose = screen(load_hand("sa"), obj, places, 2, 20, 0)
    assert loose
    assert all(np.degrees(combination.askew_rad) > 25.0 for combination in loose)
    facing = [PairLimits(askew_rad=np.radians(4.0))]
    assert screen(load_hand("sa"), obj, places, 2, 20, 0, limits=facing) == []
    trimesh.creation.cylinder(0.02, 0.06, sections=64).export(tmp_path / "can.stl")
    can = load_object(tmp_path / "can.stl", friction=0.6)
    places = [site for site in surface_sites(can, 96, 0)[0] if abs(site.normal[2]) < 0.5]
    assert screen(load_hand("sa"), can, places, 2, 20, 0, limits=facing)
    tried = Tried(2, sites=96, askew_deg=38.2)
    assert "38 deg askew at best: try a hand whose fingers bend" in tried.remedy
    assert "align_within_deg: 20 at both contacts" in tried.remedy


def test_by_how_much_sites_are_askew_is_exact() -> None:
    """A patch that bends by 20 degrees, a cap of 30 degrees, and points that face them at an angle."""
    half, radius = np.radians(10.0), 0.02
    # The arc as a quadratic: its end normals are exact, and that is where the nearest one lies.
    ends = [np.array([np.sin(a), 0.0, np.cos(a)]) * radius for a in (-half, half)]
    top = np.array([0.0, 0.0, radius / np.cos(half)])
    across = [np.array([0.0, y, 0.0]) for y in (-0.005, 0.005)]
    patch = Patch(BezierPatch(np.array([[p + y for y in across] for p in (ends[0], top, ends[1])])))
    cap = Cap(np.zeros(3), radius, np.array([0.0, 0.0, 1.0]), np.radians(30.0))
    for angle_deg in (4.0, 35.0):
        angle = np.radians(angle_deg)
        normal = -np.array([np.sin(angle), 0.0, np.cos(angle)])
        point = Site("", PointRegion(np.zeros(3), normal), np.zeros(3), normal)
        for region, reach_deg in ((patch, 10.0), (cap, 30.0)):
            site = Site("", region, *region.middle())
            assert np.degrees(askew_rad(site, point)) == pytest.approx(
                max(0.0, angle_deg - reach_deg), abs=0.1
            )
            assert np.degrees(askew_rad(point, site)) == pytest.approx(
                max(0.0, angle_deg - reach_deg), abs=0.1
            )


def test_what_is_too_wide_for_a_jaw_is_said_with_both_widths(jaw: Hand, tmp_path: Path) -> None:
    trimesh.creation.box((0.12, 0.13, 0.14)).export(tmp_path / "crate.stl")
    search = searches(jaw, load_object(tmp_path / "crate.stl"), 2)[0]
    assert not search.can_carry()
    assert "opens to 90 mm, and places that carry it are 120 mm apart at least" in search.tried.remedy


def test_no_more_contacts_are_advised_than_the_hand_has() -> None:
    for counts in ({"carrying": 5, "weak": 3}, {"carrying": 0, "weak": 3}, {"carrying": 5, "sinking": 3}):
        jaws = Tried(2, 2, sites=96, combinations=5, tasks=3, **counts)
        fingers = Tried(2, 5, sites=96, combinations=5, tasks=3, **counts)
        assert "--contacts" not in jaws.remedy and "--contacts" in fingers.remedy
    assert "--contacts" not in Tried(2, 2, sites=96).remedy


def test_fewer_contacts_are_advised_where_many_are_not_reached():
    few, many = (Tried(n, 5, sites=96, combinations=5, tasks=3, carrying=5, unreached=3) for n in (3, 5))
    assert "do not reach" in few.remedy and "--contacts" not in few.remedy
    assert "do not reach: try --contacts 4, " in many.remedy


def test_three_sites_balance_forces_within_friction_cones(box: Path) -> None:
    obj = load_object(box)
    found = screen(load_hand("sa"), obj, sites(obj), 3, 5, 0)
    assert found
    for combination in found:
        assert _can_balance(combination.sites, obj.friction)


@pytest.mark.slow
def test_a_heavy_object_is_looked_at_for_more_fingers(tmp_path: Path) -> None:
    """A pinch carries 2 x 0.6 x 38 N at most, 45 N; 1.5 times the weight of 3.3 kg is 49 N."""
    path, hand = tmp_path / "block.stl", load_hand("sa")
    trimesh.creation.box((0.04, 0.06, 0.08)).export(path)
    light, heavy, huge = (load_object(path, mass_kg=mass) for mass in (0.2, 3.3, 60.0))
    assert [search.tried.contacts for search in searches(hand, light)] == [2, 3]
    fewest = searches(hand, heavy)[0].tried
    assert fewest.contacts > 2
    assert fewest.carrying > 0
    assert [search.tried.contacts for search in searches(hand, heavy, 2)] == [2]
    assert not can_ever_carry(hand, huge, 5)
    assert can_ever_carry(hand, heavy, 2)


def test_combinations_that_carry_come_first(tmp_path: Path) -> None:
    path, hand = tmp_path / "block.stl", load_hand("sa")
    trimesh.creation.box((0.04, 0.06, 0.02)).export(path)
    obj = load_object(path, mass_kg=1.6)
    found = screen(hand, obj, sites(obj), 2, 20, 0)
    assert [c.carries for c in found] == sorted((c.carries for c in found), reverse=True)
    worth = [c.worth for c in found if not c.carries]
    assert worth == sorted(worth, reverse=True)
    assert 0 < sum(c.carries for c in found) < len(found)
    light = screen(hand, load_object(path, mass_kg=0.05), sites(obj), 2, 20, 0)
    assert all(c.carries for c in light)


def _can_balance(chosen, mu: float) -> bool:
    """Whether forces on edges of the friction cones cancel, none of them zero: a linear programme."""
    columns = []
    for site in chosen:
        tangent = np.linalg.svd(site.normal[None])[2][1:]
        for angle in np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False):
            force = -site.normal + mu * (np.cos(angle) * tangent[0] + np.sin(angle) * tangent[1])
            columns.append(np.concatenate([force, np.cross(site.point, force)]))
    wrenches = np.array(columns).T
    sums = np.kron(np.eye(len(chosen)), np.ones(16))
    result = linprog(
        np.zeros(wrenches.shape[1]), A_ub=-sums, b_ub=-np.ones(len(chosen)), A_eq=wrenches, b_eq=np.zeros(6)
    )
    return result.status == 0


def test_suggestions_are_certified_and_ranked(suggestions: list[Suggestion]) -> None:
    assert len(suggestions) == 2
    scores = [s.score for s in suggestions]
    assert scores == sorted(scores, reverse=True)
    for s in suggestions:
        assert 0.0 < s.reach <= 1.0
        assert s.quality.epsilon > 0.0
        assert certify_state(ContactManifold(s.task), s.configuration.state).certified


def test_the_same_seed_gives_the_same(suggestions: list[Suggestion], box: Path) -> None:
    again = suggest(load_hand("sa"), load_object(box), count=2, budget_s=600.0)
    assert [s.touching for s in again] == [s.touching for s in suggestions]


def test_the_command_writes_tasks_that_can_be_solved(box: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["suggest", str(box), "--count", "1", "--quiet", "--json", "-"]) == 0
    (entry,) = json.loads(capsys.readouterr().out)["suggestions"]
    task = load_task(entry["task"])
    assert Path(entry["task"]).parent == box.parent
    assert solve(task, candidates=1).verdict is Verdict.SOLVED


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["nothing"], "unknown object"),
        (["scalpel", "--hand", "as"], "unknown hand"),
        (["scalpel", "--contacts", "1"], "at least 2"),
        (["scalpel", "--contacts", "9"], "at most"),
    ],
)
def test_misuse_is_told(
    words: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["suggest", *words, "--out", str(tmp_path), "--quiet"]) == 2
    assert told in capsys.readouterr().err


def test_task_files_elsewhere_have_a_copy_of_the_object(box: Path, tmp_path: Path, capsys) -> None:
    words = ["suggest", str(box), "--out", str(tmp_path), "--count", "1", "--quiet", "--json", "-"]
    assert main(words) == 0
    (entry,) = json.loads(capsys.readouterr().out)["suggestions"]
    assert Path(entry["task"]).parent == tmp_path and (tmp_path / box.name).is_file()
    assert load_task(entry["task"]).object.name == load_object(box).name


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> ObjectModel:
    """A sheet of 2 mm, of facets that are long and thin."""
    path = tmp_path_factory.mktemp("plate") / "plate.stl"
    trimesh.creation.box((0.08, 0.05, 0.002)).export(path)
    return load_object(path)


def test_a_thin_sheet_has_places_on_its_rims(plate: ObjectModel) -> None:
    places = edge_sites(plate, 50, 0)
    assert len(places) == 50
    for site in places:
        # Two of the three coordinates lie on a face each, and the normal looks out between these faces.
        on_face = np.abs(np.abs(site.point) - plate.mesh.extents / 2) < 1e-7
        assert on_face.sum() == 2
        assert np.allclose(site.normal, np.where(on_face, np.sign(site.point), 0.0) / np.sqrt(2.0))


def test_no_place_is_left_out_for_being_near_an_edge(plate: ObjectModel) -> None:
    places, covered = surface_sites(plate, 200, 0)
    assert (len(places), covered) == (200, 0.0)
    for site in places:
        assert np.min(np.abs(np.abs(site.point) - plate.mesh.extents / 2)) < 1e-6


def test_places_in_a_hollow_that_a_piece_fills_are_covered() -> None:
    ring = trimesh.creation.annulus(0.02, 0.03, 0.02)
    part = Part("ring", ring, (Hull.from_points(ring.vertices),), solid_inertia(ring, 500.0))
    obj = ObjectModel("ring", (part,), 0.6, {})
    points = np.array(ring.sample(400, seed=0))
    inner = (np.linalg.norm(points[:, :2], axis=1) < 0.025) & (np.abs(points[:, 2]) < 0.0099)
    assert np.array_equal(are_covered(obj, points), inner)
    places, covered = surface_sites(obj, 100, 0)
    assert len(places) == 100
    assert covered == pytest.approx(
        ring.area_faces[np.linalg.norm(ring.triangles_center[:, :2], axis=1) < 0.0205].sum() / ring.area,
        abs=0.05,
    )


def test_no_is_said_only_when_time_is_over(tmp_path: Path) -> None:
    path = tmp_path / "crate.stl"
    trimesh.creation.box((0.4, 0.4, 0.4)).export(path)
    made = 0

    def count(tries: int, _: int) -> None:
        nonlocal made
        made = tries

    found = suggest(
        load_hand("sa"), load_object(path), budget_s=1e6, on_progress=count, should_stop=lambda: made > 40
    )
    assert not found
    tried = found.tried
    assert tried.tasks == tried.unreached + tried.sinking + tried.weak > 40
    for word in ("places on the surface", "combinations with force closure", "not reached", "try"):
        assert word in str(found)


def test_a_try_under_way_is_given_up_and_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped within its first try, a search goes on as one that never was."""
    path = tmp_path / "box.stl"
    trimesh.creation.box((0.03, 0.04, 0.05)).export(path)
    hand, obj = load_hand("sa"), load_object(path)
    tried: list[tuple[str, ...]] = []
    is_over = False

    def stand_in(task: Task, *_: object) -> Outcome:
        nonlocal is_over
        tried.append(tuple(contact.hand.name for contact in task.contacts))
        if len(tried) == 1:
            is_over = True
        give_up_if_asked()
        return Outcome("unreached")

    monkeypatch.setattr("holdfast.pipeline.suggest.search.try_task", stand_in)
    search = searches(hand, obj, 2)[0]
    assert search.more(1, budget_s=1e6, should_stop=lambda: is_over) == []
    assert len(tried) == 1 and search.outcomes == [] and search.tried.tasks == 0
    is_over = False
    assert search.more(1, budget_s=1e6, tries=4) == []
    assert tried[1] == tried[0] and len(search.outcomes) == len(tried) - 1


def test_what_is_suggested_is_clear_and_carries_the_load(suggestions: list[Suggestion]) -> None:
    for s in suggestions:
        assert s.configuration.certified
        assert compute_clearance(s.task, s.configuration.state).is_clear
        assert s.quality.wrench_margin >= 1.0
        assert s.grasp.squeeze.load_factor >= 1.0


def test_a_mesh_becomes_an_object_file_beside_its_tasks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    trimesh.creation.box((40.0, 60.0, 20.0)).export(tmp_path / "block.stl")
    figures = ["--mass", "0.2", "--friction", "0.5", "--units", "mm", "--quiet"]
    assert main(["suggest", "block.stl", *figures, "--count", "1", "--json", "-"]) == 0
    said = json.loads(capsys.readouterr().out)
    task = load_task(said["suggestions"][0]["task"])
    assert (task.object.friction, task.object.inertia.mass) == (0.5, pytest.approx(0.2))
    assert task.object.mesh.extents == pytest.approx([0.04, 0.06, 0.02])
    assert said["tried"]["contacts"] == 2 and said["tried"]["sites"] >= 96
    assert main(["solve", "block.stl", *figures, "--first", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)["solutions"]) == 1
    assert sorted(path.suffix for path in (tmp_path / "block_task").iterdir()) == [".stl", ".yaml", ".yaml"]
    assert main(["objects", "block.stl", "--units", "mm", "--mass", "0.2"]) == 0
    assert "40.0 x 60.0 x 20.0 mm" in capsys.readouterr().out


def test_what_goes_with_a_mesh_is_refused_without_one(box: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["suggest", str(box)], ["solve", "upholding"], ["run", "upholding"], ["objects", str(box)]):
        assert main([*words, "--mass", "0.2"]) == 2
        assert "mesh" in capsys.readouterr().err
