"""A guitar of convex pieces: body, bridge, fingerboard, frets, neck with heel, head, keys and strings."""

import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ...geometry import BezierPatch, Box, Hull, combined_mass, pose, shape_mesh
from ...geometry.solids import Loft, shell_inertia, solid_inertia
from ..object_model import Part
from .convex import convex_part
from .generated import GeneratedShape
from .guitar_plan import BENCHMARK, REAL, GuitarPlan

__all__ = ["guitar", "guitar_real"]

RGBA = tuple[float, float, float, float]

# kg/m^3: cedar or mahogany of neck and head, ebony, nickel silver, strings (nylon and wound, on average),
# rosewood of the bridge, and keys of plastic on steel shafts.
_NECK, _EBONY, _FRET, _STRING, _ROSEWOOD, _KEY = 500.0, 1100.0, 8700.0, 4000.0, 850.0, 2000.0
# Plates of 2.6 mm of spruce and rosewood (600 kg/m^3 on average), a quarter more for braces and linings.
_SHELL_KG_PER_M2 = 0.0026 * 600.0 * 1.25
_SPRUCE: RGBA = (0.87, 0.68, 0.40, 1.0)
_MAHOGANY: RGBA = (0.45, 0.25, 0.14, 1.0)
_BLACK: RGBA = (0.12, 0.09, 0.08, 1.0)
_NICKEL: RGBA = (0.80, 0.80, 0.78, 1.0)
_PEARL: RGBA = (0.93, 0.92, 0.86, 1.0)
# Radius of the fingerboard's rolled edges.
_ROLL_M = 0.003
_STRINGS = range(1, 7)
# Frets up to this one have regions: those of open chords.
_LAST_CHORD_FRET = 5


def guitar() -> GeneratedShape:
    """The benchmark's oversize guitar, 1425 mm long, in its published frame."""
    return _guitar(BENCHMARK)


def guitar_real() -> GeneratedShape:
    """A classical guitar of real size: 985 mm long, scale 650 mm, 52 mm wide at the nut."""
    return _guitar(REAL)


def _guitar(plan: GuitarPlan) -> GeneratedShape:
    """Builds the parts and the surfaces that regions may be cut from.

    Parts: `body`, `bridge`, `rosette`, `neck` (with heel), `head`, `fingerboard`, `frets`, `key_1..6`,
    `string_1..6`; key 1 winds string 1, the high e.

    Surfaces: `neck_back` (u from the joint, where the heel covers it, to the nut, v from bass to treble),
    `edge_treble` and `edge_bass`, the rolled edges of the fingerboard (u from the joint to the nut),
    `key_<n>_top` and `key_<n>_bottom` (u along the paddle towards the head's end), and
    `string_<n>_fret_<m>`, the upper side of a string between fret m - 1 and fret m (u from the fret towards
    the nut, v across).
    """
    keys = [_key(plan, n) for n in _STRINGS]
    strings = [_string(plan, n) for n in _STRINGS]
    parts = [_body(plan), _bridge(plan), _rosette(plan), _neck(plan), _head(plan), _fingerboard(plan)]
    surfaces = {
        "neck_back": _neck_back(plan),
        "edge_treble": _board_edge(plan, -1.0),
        "edge_bass": _board_edge(plan, 1.0),
    }
    for n in _STRINGS:
        for face, side in (("top", 1.0), ("bottom", -1.0)):
            surfaces[f"key_{n}_{face}"] = _key_face(plan, n, side)
        for fret in range(1, _LAST_CHORD_FRET + 1):
            surfaces[f"string_{n}_fret_{fret}"] = _string_top(plan, n, fret)
    return GeneratedShape((*parts, _frets(plan), *keys, *strings), surfaces)


def _compound(name: str, hulls: list[Hull], density: float, rgba: RGBA) -> Part:
    """A part of several convex pieces, each a closed surface; what they share weighs twice."""
    solids = [trimesh.Trimesh(hull.vertices, hull.faces, process=False) for hull in hulls]
    inertia = combined_mass(solid_inertia(solid, density) for solid in solids)
    whole = trimesh.util.concatenate(solids)
    assert isinstance(whole, trimesh.Trimesh)
    return Part(name, whole, tuple(hulls), inertia, rgba)


def _box(low: list[float], high: list[float]) -> Hull:
    middle, half = 0.5 * (np.array(low) + np.array(high)), 0.5 * (np.array(high) - np.array(low))
    return Hull.from_points(np.array(shape_mesh(Box(pose(np.eye(3), middle), half)).vertices))


# ---- body


def _outline(plan: GuitarPlan) -> Array:
    """Half-widths (n, 2) of the body as (x, w) from tail to joint: two bouts, each half a superellipse."""
    tail, lower, waist, upper, joint = plan.stations
    wide, narrow, shoulder = plan.half_widths
    tail_end = [(lower - (lower - tail) * c, wide * w) for c, w in _superellipse(2.3, 0.12, 14)]
    front_end = [(upper + (joint - upper) * c, shoulder * w) for c, w in _superellipse(2.5, 0.30, 12)]
    sides = [
        (a + (b - a) * t, wa + (wb - wa) * t * t * (3.0 - 2.0 * t))
        for a, b, wa, wb in ((lower, waist, wide, narrow), (waist, upper, narrow, shoulder))
        for t in np.arange(1, 12) / 12.0
    ]
    middle = [*sides[:11], (waist, narrow), *sides[11:]]
    return np.array([*tail_end, *middle, *front_end[::-1]])


def _superellipse(power: float, first: float, count: int) -> list[tuple[float, float]]:
    """Points (c, w) of c^p + w^p = 1 from the end, cut flat at w = `first`, to (0, 1)."""
    angles = np.linspace(np.arcsin(first ** (power / 2.0)), np.pi / 2.0, count)
    c, w = np.cos(angles) ** (2.0 / power), np.sin(angles) ** (2.0 / power)
    return list(zip((c / c[0]).tolist(), w.tolist(), strict=True))


def _body(plan: GuitarPlan) -> Part:
    x, w = _outline(plan).T
    low, middle, high = plan.back_z, 0.5 * (plan.back_z + plan.top_z), plan.top_z
    # With points half-way up the sides, for those of the edges lie on the hull of any piece.
    corners = [(-1, low), (-1, middle), (-1, high), (1, high), (1, middle), (1, low)]
    rings = [np.column_stack([x, plan.centre_y + side * w, np.full_like(x, z)]) for side, z in corners]
    loft = Loft(np.stack(rings, axis=1))
    mesh = loft.mesh()
    inertia = shell_inertia(np.array(mesh.triangles), _SHELL_KG_PER_M2)
    # Runs of sections on which the outline is convex are one piece, without any loss.
    return Part("body", mesh, loft.pieces(loft.find_cuts(1e-7)), inertia, _SPRUCE)


def _bridge(plan: GuitarPlan) -> Part:
    along, across = plan.bridge_half
    x, y = plan.bridge_x, plan.centre_y
    foot = plan.top_z + 0.4 * (plan.string_z[1] - plan.top_z)
    saddle = plan.string_z[1] - max(plan.string_radii)
    half = 0.55 * plan.string_spread[1]
    base = _box([x - 1.4 * along, y - across, plan.top_z], [x + 0.6 * along, y + across, foot])
    bone = _box([x - 0.002, y - half, foot], [x + 0.002, y + half, saddle])
    return _compound("bridge", [base, bone], _ROSEWOOD, _MAHOGANY)


def _rosette(plan: GuitarPlan) -> Part:
    """The sound hole as a dark disc on the top, for a part must be closed and the body is a prism."""
    x, radius = plan.hole
    angles = np.arange(48) * 2.0 * np.pi / 48
    ring = np.column_stack([x + radius * np.cos(angles), plan.centre_y + radius * np.sin(angles)])
    points = [np.column_stack([ring, np.full(48, z)]) for z in (plan.top_z, plan.top_z + 0.0004)]
    return convex_part("rosette", Hull.from_points(np.concatenate(points)), _ROSEWOOD, _BLACK)


# ---- neck and head


def _neck_back(plan: GuitarPlan) -> BezierPatch:
    """The back of the neck below the fingerboard, of degree 1 along and 3 across."""
    top = plan.board_z - plan.board_thickness
    net = []
    for x in (plan.joint_x, plan.nut_x):
        w, depth = plan.neck_half_width(x), plan.neck_depth(x)
        # A cubic whose inner points lie 4/3 deep reaches the depth in its middle.
        low = top - 4.0 / 3.0 * (depth - plan.board_thickness)
        net.append([(x, plan.centre_y + s * w, z) for s, z in ((1, top), (1, low), (-1, low), (-1, top))])
    return BezierPatch(np.array(net))


def _neck(plan: GuitarPlan) -> Part:
    patch, v = _neck_back(plan), np.linspace(0.0, 1.0, 41)
    back = Hull.from_points(np.vstack([patch.evaluate(np.full_like(v, u), v) for u in (0.0, 1.0)]))
    x, length = plan.joint_x, plan.heel_length
    under = [plan.board_z - 0.8 * plan.neck_depth(x + d) for d in (0.0, length)]
    ends = [(x, 0.8, plan.back_z + 0.004), (x + length, 0.55, plan.board_z - 0.97 * plan.neck_depth(x))]
    heel = [
        (at, plan.centre_y + side * share * plan.neck_half_widths[0], z)
        for (at, share, low), high in zip(ends, under, strict=True)
        for side in (-1.0, 1.0)
        for z in (low, high)
    ]
    return _compound("neck", [back, Hull.from_points(np.array(heel))], _NECK, _MAHOGANY)


def _head(plan: GuitarPlan) -> Part:
    """The plate, the wood that joins it to the neck, and the posts that the strings are wound on."""
    first, last = plan.head_x
    half = 0.5 * plan.head_thickness
    plate = [
        (x, plan.centre_y + side * share * plan.head_half_width, plan.head_z(x) + dz)
        for x, share in ((first, 0.92), (first + 0.02, 1.0), (last - 0.02, 1.0), (last, 0.8))
        for side in (-1.0, 1.0)
        for dz in (-half, half)
    ]
    width = plan.neck_half_widths[1]
    joint = [
        (x, plan.centre_y + side * w, z)
        for x, w, heights in (
            (plan.nut_x, width, (plan.board_z, plan.board_z - 0.6 * plan.neck_depths[1])),
            (plan.nut_x, 0.6 * width, (plan.board_z - 0.93 * plan.neck_depths[1],)),
            (first, 0.92 * plan.head_half_width, (plan.head_z(first) - half, plan.head_z(first) + half)),
        )
        for side in (-1.0, 1.0)
        for z in heights
    ]
    # The nut carries the strings a little above the frets.
    nut = _box(
        [plan.nut_x, plan.centre_y - width, plan.board_z - 0.002],
        [plan.nut_x + 0.006, plan.centre_y + width, plan.string_z[0] - max(plan.string_radii)],
    )
    posts = [_cylinder(_post(plan, n, -half), _post(plan, n, half + 0.006), 0.0035, 16) for n in _STRINGS]
    hulls = [Hull.from_points(np.array(plate)), Hull.from_points(np.array(joint)), nut, *posts]
    return _compound("head", hulls, _NECK, _MAHOGANY)


def _post(plan: GuitarPlan, string: int, height: float) -> Array:
    """Point (3,) of a post's axis at a height above the middle of the head's plate."""
    x, side = _key_place(plan, string)
    normal = np.array([plan.key_slope, 0.0, 1.0]) / np.hypot(plan.key_slope, 1.0)
    middle = [x, plan.centre_y + 0.45 * side * plan.head_half_width, plan.head_z(x)]
    return np.array(middle) + height * normal


def _board_edge(plan: GuitarPlan, side: float) -> BezierPatch:
    """A rolled upper edge of the fingerboard, a quarter of a circle: of degree 1 along and 3 across."""
    reach = 4.0 / 3.0 * np.tan(np.pi / 8.0)
    # From the side (0, -1) round to the top (-1, 0), as multiples of the radius.
    arc = _ROLL_M * np.array([(0.0, -1.0), (0.0, reach - 1.0), (reach - 1.0, 0.0), (-1.0, 0.0)])
    ends = [(x, plan.neck_half_width(x)) for x in (plan.joint_x, plan.nut_x)]
    net = np.array(
        [[(x, plan.centre_y + side * (w + dy), plan.board_z + dz) for dy, dz in arc] for x, w in ends]
    )
    return BezierPatch(net if side < 0 else net[:, ::-1])


def _fingerboard(plan: GuitarPlan) -> Part:
    v = np.linspace(0.0, 1.0, 9)
    points = [
        (x, plan.centre_y + side * plan.neck_half_width(x), plan.board_z - plan.board_thickness)
        for x in (plan.board_x, plan.nut_x)
        for side in (-1.0, 1.0)
    ]
    # The board begins above the body, before the joint.
    start = (plan.board_x - plan.joint_x) / (plan.nut_x - plan.joint_x)
    edges = [_board_edge(plan, side) for side in (-1.0, 1.0)]
    rolled = [edge.evaluate(np.full_like(v, u), v) for edge in edges for u in (start, 1.0)]
    return convex_part("fingerboard", Hull.from_points(np.vstack([points, *rolled])), _EBONY, _BLACK)


def _frets(plan: GuitarPlan) -> Part:
    """Bars with a round crown, 1.2 mm high."""
    crown = [(-0.0012, 0.0), (-0.0009, 0.0008), (0.0, 0.0012), (0.0009, 0.0008), (0.0012, 0.0)]
    hulls = []
    for number in range(1, plan.frets + 1):
        x = plan.fret_x(number)
        half = plan.neck_half_width(x) - _ROLL_M
        points = [(x + a, plan.centre_y + s * half, plan.board_z + b) for a, b in crown for s in (-1.0, 1.0)]
        hulls.append(Hull.from_points(np.array(points)))
    return _compound("frets", hulls, _FRET, _NICKEL)


# ---- keys


def _key_place(plan: GuitarPlan, string: int) -> tuple[float, float]:
    """Where a key is along x, and its side: keys 3, 2, 1 follow the nut at low y, keys 4, 5, 6 at high y."""
    number = 3 - string if string <= 3 else string - 4
    return plan.key_first[0] + number * plan.key_pitch, -1.0 if string <= 3 else 1.0


def _key_frame(plan: GuitarPlan, string: int) -> tuple[Array, Array]:
    """Axes (3, 3) of a paddle as columns (along the head, +y, out of the top) and its middle (3,)."""
    x, side = _key_place(plan, string)
    along = np.array([1.0, 0.0, -plan.key_slope]) / np.hypot(plan.key_slope, 1.0)
    axes = np.column_stack([along, [0.0, 1.0, 0.0], np.cross(along, [0.0, 1.0, 0.0])])
    return axes, np.array([x, plan.centre_y + side * plan.key_reach, plan.head_z(x)])


def _key_face(plan: GuitarPlan, string: int, side: float) -> BezierPatch:
    """A face of a paddle, bulging both ways: z = half (1 - bulges a^2 - b^2), biquadratic in its plane."""
    length, width, half = plan.key_half
    axes, middle = _key_frame(plan, string)
    # Quadratic control values of 1 - s^2 over [-1, 1] are (0, 2, 0), of the constant 1 (1, 1, 1).
    shape = np.array([0.0, 2.0, 0.0])
    height = half - plan.key_bulge[0] * (1.0 - shape)[:, None] - plan.key_bulge[1] * (1.0 - shape)[None, :]
    a, b = np.meshgrid(length * np.arange(-1.0, 2.0), width * np.arange(-1.0, 2.0), indexing="ij")
    net = middle + np.stack([a, b, side * height], axis=-1) @ axes.T
    return BezierPatch(net if side > 0 else net[:, ::-1])


def _key(plan: GuitarPlan, string: int) -> Part:
    """A paddle with a rounded outline, and the shaft that it turns about."""
    s = np.linspace(-1.0, 1.0, 15)
    a, b = (grid.ravel() for grid in np.meshgrid(s, s, indexing="ij"))
    # From the square to the superellipse of power 4.
    shrink = np.maximum(np.abs(a), np.abs(b)) / np.maximum((a**4 + b**4) ** 0.25, 1e-12)
    u, v = 0.5 + 0.5 * a * shrink, 0.5 + 0.5 * b * shrink
    faces = [_key_face(plan, string, 1.0).evaluate(u, v), _key_face(plan, string, -1.0).evaluate(u, v)]
    paddle = Hull.from_points(np.vstack(faces))
    _, side = _key_place(plan, string)
    _, middle = _key_frame(plan, string)
    root, end = middle.copy(), middle.copy()
    root[1] -= side * 0.9 * plan.key_half[1]
    end[1] = plan.centre_y + side * plan.head_half_width
    return _compound(f"key_{string}", [paddle, _cylinder(root, end, 0.0025, 16)], _KEY, _PEARL)


# ---- strings


def _string(plan: GuitarPlan, string: int) -> Part:
    """The free length, and the end that runs from the nut to its post."""
    radius = plan.string_radii[string - 1]
    saddle, nut = (plan.string_point(string, x) for x in (plan.bridge_x, plan.nut_x))
    free = _cylinder(saddle, nut, radius, 24)
    end = _cylinder(nut, _post(plan, string, 0.5 * plan.head_thickness + 0.003), radius, 12)
    return _compound(f"string_{string}", [free, end], _STRING, _NICKEL)


def _string_top(plan: GuitarPlan, string: int, fret: int) -> BezierPatch:
    """The upper 80 degrees of a string between two frets, of degree 1 along and 2 across."""
    radius, half = plan.string_radii[string - 1], np.deg2rad(40.0)
    # The parabola with the circle's tangents at both ends; it leaves the circle by < 2 % of the radius.
    across = radius * np.array(
        [(-np.sin(half), np.cos(half)), (0.0, 1.0 / np.cos(half)), (np.sin(half), np.cos(half))]
    )
    ends = [plan.string_point(string, x) for x in (plan.fret_x(fret), plan.fret_x(fret - 1))]
    return BezierPatch(np.array([[end + np.array([0.0, y, z]) for y, z in across] for end in ends]))


def _cylinder(start: Array, end: Array, radius: float, sides: int) -> Hull:
    """A straight prism with `sides` sides about the segment from `start` to `end`."""
    axis = (end - start) / np.linalg.norm(end - start)
    # A corner points along z, or along x where the axis is upright.
    e1 = np.cross(axis, [0.0, 1.0, 0.0]) if abs(axis[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    e1 = -e1 / np.linalg.norm(e1)
    e2 = np.cross(axis, e1)
    angles = np.arange(sides) * 2.0 * np.pi / sides
    ring = radius * (np.cos(angles)[:, None] * e1 + np.sin(angles)[:, None] * e2)
    return Hull.from_points(np.vstack([start + ring, end + ring]))
