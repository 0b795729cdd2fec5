"""The part of a grasp file that holds what was proved beside the verdict, for `check-proof` to check."""

import hashlib
import json
from dataclasses import asdict
from typing import Annotated, Any, TypeAlias

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer

from ...base.files.fields import Finite
from ...base.files.file_model import FileModel
from ...evidence import CertifiedClear, CertifiedStable, NotCertified, Plane
from ...evidence import Evidence as FoundEvidence
from ...solver import SolutionRadii

__all__ = ["Clear", "EvidenceRecord", "Radii", "Stable", "evidence_record", "seal_of"]

NotNegative: TypeAlias = Annotated[float, Field(ge=0, allow_inf_nan=False)]
PlaneRecord: TypeAlias = tuple[
    Annotated[int, Field(ge=-1)],
    Annotated[int, Field(ge=1)],
    Annotated[int, Field(ge=0)],
    Finite,
    Finite,
    Finite,
]
"""Step of the approach (-1: the grasp), stretch of the step, pair of pieces, and the normal between them."""


class Radii(FileModel):
    """A true solution of the contacts is so close to the written numbers.

    Attributes:
        joints: every independent joint, in rad or m.
        rotation: every entry of the rotation that the quaternion stands for.
        position: every coordinate, in m.
        parameters: every parameter.
    """

    joints: NotNegative
    rotation: NotNegative
    position: NotNegative
    parameters: NotNegative


class InBody(FileModel):
    """A point of a convex piece, a mixture of vertices.

    Attributes:
        piece: number of the piece.
        vertices: of it.
        weights: of all but the first, which has what is left to one.
    """

    piece: Annotated[int, Field(ge=0)]
    vertices: Annotated[list[Annotated[int, Field(ge=0)]], Field(min_length=1)]
    weights: list[NotNegative]


class WidePoint(FileModel):
    """Where a force acts on a wide contact beside its point.

    Attributes:
        contact: number of the contact, from 0.
        offset: from the contact's point in the palm frame, in m; what counts is its part in the tangent
            plane.
        hand: a point of the link nearby.
        object: a point of the object nearby.
    """

    contact: Annotated[int, Field(ge=0)]
    offset: tuple[Finite, Finite, Finite]
    hand: InBody
    object: InBody


class Stable(FileModel):
    """True forces balance the load in every direction of the test, inside the friction cones and efforts.

    Attributes:
        slack: what every contact may lose, in N, before it slips, in every direction.
        effort_share: the largest share of any servo's effort that is used.
        error: how far the true forces are from `forces` at most, in N and N m.
        wide: force points beside those of the contacts; left out where there are none.
        forces: for each direction and force point, those of the contacts first, the force on the object in
            the palm frame in N, and the torque on it about the inward normal in N m.
    """

    slack: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    effort_share: NotNegative
    error: NotNegative
    wide: list[WidePoint] = []
    forces: list[list[tuple[Finite, Finite, Finite, Finite]]]

    @model_serializer(mode="wrap")
    def _without_nothing(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Without an empty list, for the checksum of a file knows of what it was written with."""
        data: dict[str, Any] = write(self)
        return data if self.wide else {name: value for name, value in data.items() if name != "wide"}


class Clear(FileModel):
    """Nothing sinks in deeper than it may, in the grasp and on the way to it.

    Attributes:
        approach: whether that holds on the way from the pregrasp, too.
        depth: how deep a pair that should not touch may sink in.
        contact_depth: how deep an intended contact may.
        margin: distance asked for in the grasp between bodies that should not touch.
        planes: planes that part pairs of pieces which the 13 common directions don't.
    """

    approach: bool
    depth: NotNegative
    contact_depth: NotNegative
    margin: NotNegative
    planes: list[PlaneRecord]


class EvidenceRecord(FileModel):
    """What was proved of a grasp, about its numbers as they are written.

    Attributes:
        radii: how close to them the true solution is; None where nothing was proved.
        stable: None where it was not proved.
        clear: None where it was not proved.
        reasons: why what was not proved was not.
        seal: a checksum over this and what it speaks of, which shows any later change; see `sealed`.
    """

    radii: Radii | None = None
    stable: Stable | None = None
    clear: Clear | None = None
    reasons: list[str] = []
    seal: str = ""


def evidence_record(found: FoundEvidence) -> EvidenceRecord:
    """The written form of evidence."""
    stable, clear = found.stable, found.clear
    proved = [one for one in (stable, clear) if isinstance(one, (CertifiedStable, CertifiedClear))]
    return EvidenceRecord(
        radii=_radii(proved[0].radii) if proved else None,
        stable=_stable(stable) if isinstance(stable, CertifiedStable) else None,
        clear=_clear(clear) if isinstance(clear, CertifiedClear) else None,
        reasons=[str(one) for one in (stable, clear) if isinstance(one, NotCertified)],
    )


def seal_of(record: FileModel) -> str:
    """SHA-256 (64 hex digits) of what a grasp's evidence speaks of, from the grasp's record with evidence."""
    data = record.model_dump(mode="json")
    hold, approach = data["hold"] or {}, data["approach"] or {}
    evidence = {name: value for name, value in data["evidence"].items() if name != "seal"}
    said = {
        "joints": data["joints"],
        "object": data["object"],
        "parameters": data["parameters"],
        "waypoints": approach.get("waypoints"),
        "settings": hold.get("settings"),
        "spin_arms": (hold.get("squeeze") or {}).get("spin_arms"),
        "evidence": evidence,
    }
    text = json.dumps(said, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _radii(radii: SolutionRadii) -> Radii:
    return Radii(
        joints=radii.joints, rotation=radii.rotation, position=radii.position, parameters=radii.parameters
    )


def _stable(found: CertifiedStable) -> Stable:
    return Stable(
        slack=found.slack_N,
        effort_share=found.effort_share,
        error=found.error_N,
        wide=[
            WidePoint(
                contact=point.contact,
                offset=point.offset_m,
                hand=InBody(**asdict(point.in_hand)),
                object=InBody(**asdict(point.in_object)),
            )
            for point in found.wide
        ],
        forces=found.forces.tolist(),
    )


def _clear(found: CertifiedClear) -> Clear:
    return Clear(
        approach=found.approach,
        depth=found.depth_m,
        contact_depth=found.contact_depth_m,
        margin=found.margin_m,
        planes=[_plane(plane) for plane in found.planes],
    )


def _plane(plane: Plane) -> PlaneRecord:
    return -1 if plane.step is None else plane.step, plane.cell, plane.pair, *plane.normal
