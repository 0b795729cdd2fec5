"""A task as plain data, which the caller vouches for, and a grasp's own numbers, which nobody does."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.numeric.arrays import Array, Indices
from ..reading import Rejected, items, numbers
from .spans import Spans

__all__ = ["Contact", "Form", "Link", "Pad", "Piece", "Region", "Written", "field", "number"]


@dataclass(frozen=True, eq=False)
class Region:
    """A region of a body.

    Attributes:
        kind: `cap`, `patch` or `point`.
        radius: of a cap, in m; else 0.
        point: (3,) the centre of a cap, or the point.
        normal: (3,) the axis of a cap, or the normal of a point, of any length.
        least_cosine: of the angle between a cap's normal and its axis.
        net: (m + 1, n + 1, 3) control points of a patch.
    """

    kind: str
    radius: float
    point: Spans
    normal: Spans
    least_cosine: float
    net: Spans

    @classmethod
    def read(cls, data: Any) -> "Region":
        """From plain data."""
        kind = field(data, "kind", str)
        zero = Spans.of(np.zeros(3))
        if kind == "patch":
            rows = items(data.get("net"))
            net = np.array([[numbers(point, 3) for point in items(row)] for row in rows])
            return cls(kind, 0.0, zero, zero, -1.0, Spans.of(net))
        point, normal = (Spans.of(numbers(data.get(name), 3)) for name in ("point", "normal"))
        radius, least = (number(data.get(name)) for name in ("radius", "least_cosine"))
        return cls(kind, radius, point, normal, least, Spans.of(np.zeros((1, 1, 3))))


@dataclass(frozen=True, eq=False)
class Link:
    """A link: its parent (-1: none), its pose with all joints at zero, whether each of its axes slides."""

    parent: int
    rotation: Spans
    position: Spans
    slides: tuple[bool, ...]


@dataclass(frozen=True, eq=False)
class Contact:
    """A contact: the hand's link, both regions, and the cosine that normals must reach at least."""

    link: int
    hand: Region
    object: Region
    least_cosine: float

    @property
    def has_room(self) -> bool:
        """Whether the normals need not be exactly opposed."""
        return self.least_cosine < 1.0


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex piece: all points within `radius` m of the hull of `core` (n, 3); link -1 is the object."""

    link: int
    core: Array
    radius: float


@dataclass(frozen=True)
class Pad:
    """The hand's pads, and what decides how wide contacts are.

    Attributes:
        modulus: elastic, in Pa.
        thickness: in m.
        flattest: curvature in 1/m below which none counts.
        sharpest: the same above.
        usual_force: in N, under which areas are taken.
        turn_share: of the rotation that the test allows, how much surfaces may turn against each other.
    """

    modulus: float
    thickness: float
    flattest: float
    sharpest: float
    usual_force: float
    turn_share: float


@dataclass(frozen=True, eq=False)
class Form:
    """A task as plain data say.

    Attributes:
        links: parents first.
        directions: (n_joints, 3) of the joints' axes, in their links.
        drives: for each joint the independent joint that moves it, with ratio and offset.
        joint_reach: (n_joints,) the farthest that a sliding joint goes from zero, in m.
        names: of the independent joints.
        limits: (n_independent, 2)
        effort: (n_independent,)
        contacts: of the task.
        pose: rotation (3, 3) and position (3,) of an object that is fixed; None where it is free.
        test: `kind`, and what it takes.
        mass: of what the hand carries, in kg.
        centre: its centre of mass (3,) in the object's frame.
        friction: of the object.
        most: largest normal force in N.
        pad: of the hand.
        pieces: of all bodies.
        pairs: (n, 2) pairs of pieces that are watched.
        intended: (n,) whether each may touch.
        stands_out: (n,) how much deeper each may sink in, in m.
    """

    links: tuple[Link, ...]
    directions: Spans
    drives: tuple[tuple[int, float, float], ...]
    joint_reach: Array
    names: tuple[str, ...]
    limits: Array
    effort: Array
    contacts: tuple[Contact, ...]
    pose: tuple[Array, Array] | None
    test: dict[str, Any]
    mass: float
    centre: Array
    friction: float
    most: float
    pad: Pad
    pieces: tuple[Piece, ...]
    pairs: Indices
    intended: "np.ndarray[Any, np.dtype[np.bool_]]"
    stands_out: Array

    @classmethod
    def read(cls, data: dict[str, Any]) -> "Form":
        """From plain data, as `grasp_form` makes them."""
        links = tuple(
            Link(
                link["parent"],
                Spans.of(np.array(link["rotation"])),
                Spans.of(np.array(link["position"])),
                tuple(link["slides"]),
            )
            for link in data["links"]
        )
        contacts = tuple(
            Contact(c["link"], Region.read(c["hand"]), Region.read(c["object"]), c["least_cosine"])
            for c in data["contacts"]
        )
        pose = data["pose"]
        return cls(
            links=links,
            directions=Spans.of(np.array(data["directions"]).reshape(-1, 3)),
            drives=tuple((j, ratio, offset) for j, ratio, offset in data["drives"]),
            joint_reach=np.array(data["joint_reach"]),
            names=tuple(data["names"]),
            limits=np.array(data["limits"]).reshape(-1, 2),
            effort=np.array(data["effort"]),
            contacts=contacts,
            pose=None if pose is None else (np.array(pose[0]), np.array(pose[1])),
            test=data["test"],
            mass=data["mass"],
            centre=np.array(data["centre"]),
            friction=data["friction"],
            most=np.inf if data["most"] is None else data["most"],
            pad=Pad(**data["pad"]),
            pieces=tuple(Piece(p["link"], np.array(p["core"]), p["radius"]) for p in data["pieces"]),
            pairs=np.array(data["pairs"], dtype=np.int64).reshape(-1, 2),
            intended=np.array(data["intended"], dtype=bool),
            stands_out=np.array(data["stands_out"]),
        )

    @property
    def n_params(self) -> int:
        """Two a patch."""
        kinds = [side.kind for contact in self.contacts for side in (contact.hand, contact.object)]
        return 2 * kinds.count("patch")

    def moves(self, link: int) -> "np.ndarray[Any, np.dtype[np.bool_]]":
        """Which joints (n_joints,) move a link."""
        out = np.zeros(len(self.drives), dtype=bool)
        firsts = np.cumsum([0, *(len(other.slides) for other in self.links)])
        while link >= 0:
            out[firsts[link] : firsts[link + 1]] = True
            link = self.links[link].parent
        return out


@dataclass(frozen=True, eq=False)
class Written:
    """A grasp as its file has it.

    Attributes:
        q: independent joints (n_independent,).
        quaternion: (4,) w, x, y, z.
        position: (3,) in m.
        params: (n_params,)
        radii: of joints, rotation, position and parameters.
    """

    q: Array
    quaternion: Array
    position: Array
    params: Array
    radii: Array

    @classmethod
    def read(cls, form: Form, record: dict[str, Any]) -> "Written":
        """From a grasp file.

        Raises:
            Rejected: it is none of this task.
        """
        joints, pose = field(record, "joints", dict), field(record, "object", dict)
        radii = field(field(record, "evidence", dict), "radii", dict)
        read = cls(
            numbers([joints.get(name) for name in form.names], len(form.names)),
            numbers(pose.get("quaternion"), 4),
            numbers(pose.get("position"), 3),
            numbers(record.get("parameters"), form.n_params),
            numbers([radii.get(n) for n in ("joints", "rotation", "position", "parameters")], 4),
        )
        if not (read.radii >= 0.0).all() or not 0.9 < np.linalg.norm(read.quaternion) < 1.1:
            raise Rejected("the grasp's numbers make no sense")
        return read


def field(data: Any, name: str, kind: type) -> Any:
    """A field of a record."""
    if isinstance(data, dict) and isinstance(data.get(name), kind):
        return data[name]
    raise Rejected(f"{name} is missing")


def number(data: Any) -> float:
    """One finite number."""
    return float(numbers([data], 1)[0])
