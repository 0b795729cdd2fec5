"""The clearance table by MuJoCo instead of FCL: other code, other algorithm, the same shapes."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ..geometry import Hull, Shape, mujoco_geom, quaternion_from_rotation
from ..hands import forward_kinematics
from ..objects import Task
from ..solver import State
from .bodies import support_shape
from .clearance import Clearance, PairClearance, build_clearance, compute_clearance
from .pairs import collision_model
from .settings import RetractionSettings, checked_settings

__all__ = ["ClearanceComparison", "compare_clearance", "compute_clearance_by_mujoco"]

# Further than any two bodies are apart: mj_geomDistance returns this where it finds nothing nearer.
_FAR_M = 10.0
# MuJoCo's own defaults, 35 iterations to 1e-6, are made for contacts at speed.
_ITERATIONS, _TOLERANCE = 200, 1e-10
# Two distances agree where they differ by no more than either.
_SAME_M, _SAME_SHARE = 1e-6, 1e-3


@dataclass(frozen=True, eq=False, repr=False)
class ClearanceComparison:
    """The clearance table of one state by FCL and by MuJoCo, pair by pair in the same order."""

    fcl: Clearance
    mujoco: Clearance

    def __str__(self) -> str:
        return f"FCL and MuJoCo differ on {len(self.differing)} of {len(self.fcl.pairs)} distances"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"

    @cached_property
    def differing(self) -> tuple[tuple[PairClearance, PairClearance], ...]:
        """The pairs on which the two differ by more than 1e-6 m and 1e-3 of the distance."""
        pairs = zip(self.fcl.pairs, self.mujoco.pairs, strict=True)
        return tuple((ours, theirs) for ours, theirs in pairs if not _agree(ours, theirs))


def _agree(ours: PairClearance, theirs: PairClearance) -> bool:
    tolerance_m = max(_SAME_M, _SAME_SHARE * abs(ours.distance_m))
    return abs(ours.distance_m - theirs.distance_m) <= tolerance_m


def compare_clearance(
    task: Task, state: State, *, settings: RetractionSettings | None = None
) -> ClearanceComparison:
    """The signed distances of all watched pairs at a state by FCL and, independently, by MuJoCo."""
    return ClearanceComparison(
        compute_clearance(task, state, settings=settings),
        compute_clearance_by_mujoco(task, state, settings=settings),
    )


def compute_clearance_by_mujoco(
    task: Task, state: State, *, settings: RetractionSettings | None = None
) -> Clearance:
    """As `compute_clearance`, by `mujoco.mj_geomDistance`; slower, meant as an independent check.

    MuJoCo keeps mesh vertices in single precision, so the two agree to some 1e-8 m at best.
    """
    # Imported late: MuJoCo settles on its OpenGL backend when it is imported, and the caller may choose.
    import mujoco

    collision = collision_model(task)
    model = _mujoco_model(task)
    data = mujoco.MjData(model)
    Ts_link = forward_kinematics(task.hand, task.hand.expand(state.q))
    Ts_part = [state.T_palm_object] * (len(collision.bodies.bodies) - len(Ts_link))
    for i, T in enumerate([*Ts_link, *Ts_part]):
        data.mocap_pos[i] = T[:3, 3]
        data.mocap_quat[i] = quaternion_from_rotation(T[:3, :3])
    mujoco.mj_kinematics(model, data)
    # Geoms are numbered as the pieces are: body by body, in the same order.
    distances = [
        mujoco.mj_geomDistance(model, data, a, b, _FAR_M, None) for a, b in collision.piece_pairs.tolist()
    ]
    return build_clearance(collision, np.array(distances), checked_settings(settings))


@lru_cache(maxsize=16)
def _mujoco_model(task: Task) -> Any:
    """A model in which every link and part hangs free, to be placed as mocap bodies."""
    import mujoco  # late, as above

    spec = mujoco.MjSpec()
    spec.option.ccd_iterations = _ITERATIONS
    spec.option.ccd_tolerance = _TOLERANCE
    shapes: list[tuple[Shape, ...]] = [link.shapes for link in task.hand.links]
    shapes += [part.pieces for part in task.object.parts]
    shapes += [] if task.support is None else [(support_shape(task.support),)]
    for i, of_body in enumerate(shapes):
        body = spec.worldbody.add_body(name=f"body{i}", mocap=True)
        for k, shape in enumerate(of_body):
            _add_geom(spec, body, shape, f"body{i}_{k}")
    return spec.compile()


def _add_geom(spec: Any, body: Any, shape: Shape, name: str) -> None:
    """Adds a shape to MuJoCo's description of a body."""
    import mujoco  # late, as above

    kind, fields = mujoco_geom(shape)
    if "size" in fields:
        fields["size"] = np.pad(fields["size"], (0, 3 - len(fields["size"])))
    geom = body.add_geom(type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"), **fields)
    if isinstance(shape, Hull):
        geom.meshname = name
        spec.add_mesh(
            name=name,
            uservert=shape.vertices.ravel(),
            userface=shape.faces.ravel(),
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
