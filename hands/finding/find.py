"""Tips, pads, sides and the palm of a hand, found from its shapes and from what faces what when it moves."""

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError
from ...geometry import Region, Shape
from ..hand import Hand, HandRegion
from .cast import surface_points
from .facing import Facing
from .fingers import Finger, find_fingers
from .fit import Frame, fit_cap, fit_patch, fit_point
from .leaning import warn_of_leaning_pad
from .names import name_fingers
from .palm import find_palm
from .turned import warn_of_turned_hinges

__all__ = ["find_regions"]

# Farthest that a region may lie off its link: what retraction allows a contact.
_TOLERANCE_M = 1e-4
_COARSE_M = 2.5e-4
# Half sides of patches: at most, and the shares of that which are tried.
_LARGEST_M = (0.01, 0.008)
_SHARES = (1.0, 0.75, 0.55, 0.4, 0.28, 0.2)
_LEAST_HALF_M = 1.2e-3
# Where along the last link a pad lies, and a tip on it where the end is too sharp; the best place first.
_PAD_AT = (0.55, 0.65, 0.45, 0.75, 0.35)
_TIP_AT = (0.85, 0.78, 0.7, 0.92)
# How far the tip's middle leans from the pad towards the end of the finger.
_TIP_LEANS = np.radians([45.0, 30.0, 60.0, 15.0])
_CAPS = np.radians([45.0, 35.0, 25.0])
# Rays that meet other links, of all, from a side or an inner link that counts as facing them.
_FACING = 0.05
_INNER = ("medial", "proximal")


def find_regions(hand: Hand, source: str) -> dict[str, HandRegion]:
    """Regions by name: `<finger>/tip`, `/pad`, `/side`, `/far_side`, `/medial`, `/proximal`; `palm/centre`.

    A finger's pad is the side of its last link, across the axis that it bends about or along its slide, that
    looks more at the other fingers and the palm when the joints move through their ranges. Equal hands have
    equal regions.

    Warns of hinges whose axes seem to be turned round, and of jaws whose pads lean.

    Raises:
        InputError: no link with shapes moves, so there is no finger.
    """
    fingers = find_fingers(hand)
    if not fingers:
        raise InputError(
            source, "regions", "no finger was found: no link that moves has shapes; give regions"
        )
    facing = Facing(hand)
    normals = [_pad_normal(hand.links[finger.last].shapes, facing, finger) for finger in fingers]
    looks = np.array([_mean_look(facing, f, n) for f, n in zip(fingers, normals, strict=True)])
    names = name_fingers(hand, fingers, looks)
    warn_of_turned_hinges(hand, fingers, names, source)
    out: dict[str, HandRegion] = {}
    for name, finger, normal in zip(names, fingers, normals, strict=True):
        shapes = hand.links[finger.last].shapes
        out[f"{name}/tip"] = HandRegion(f"{name}/tip", finger.last, _tip(shapes, finger, normal))
        pad = _pad(shapes, finger, normal)
        out[f"{name}/pad"] = HandRegion(f"{name}/pad", finger.last, pad)
        warn_of_leaning_pad(hand, finger, normal, f"{name}/pad", pad, source)
        out |= _sides(hand, facing, name, finger, normal)
        out |= _inner(hand, facing, name, finger)
    palm = find_palm(hand, facing, [(f, n) for f, n in zip(fingers, normals, strict=True)])
    if palm is not None:
        out["palm/centre"] = HandRegion("palm/centre", 0, palm)
    return out


def _middle(finger: Finger, shapes: tuple[Shape, ...], at: float, normal: Array) -> Array:
    """The point (3,) in the middle of the last link, a share `at` of its length from the last joint."""
    points = surface_points(shapes)
    position = finger.start_m + at * finger.length_m
    across = np.cross(finger.along, normal)
    heights = points @ finger.along
    near = points[np.abs(heights - position) <= max(0.25 * finger.length_m, 2e-3)]
    near = near if len(near) else points
    side, out = near @ across, near @ normal
    return (
        position * finger.along
        + 0.5 * (side.min() + side.max()) * across
        + 0.5 * (out.min() + out.max()) * normal
    )


def _pad_normal(shapes: tuple[Shape, ...], facing: Facing, finger: Finger) -> Array:
    """Of the two sides across the bend, the one that sees more of the hand."""
    candidates = [sign * np.cross(finger.bend, finger.along) for sign in (1.0, -1.0)]
    # From inside the link: its frame may lie far off it, as between two jaws.
    point = _middle(finger, shapes, 0.6, candidates[0])
    shares = [facing.seen(finger.last, point, n, finger.own)[0] for n in candidates]
    return candidates[int(np.argmax(shares))]


def _mean_look(facing: Facing, finger: Finger, normal: Array) -> Array:
    mean = (facing.poses[:, finger.last, :3, :3] @ normal).mean(axis=0)
    return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-9))


def _patch(
    shapes: tuple[Shape, ...], frames: list[Frame], tolerance_m: float = _TOLERANCE_M
) -> Region | None:
    """The largest patch that fits at one of the frames, the first of them where sizes are equal."""
    for share in _SHARES:
        for frame in frames:
            half = _half(shapes, frame, share)
            if min(half) >= _LEAST_HALF_M:
                patch = fit_patch(shapes, frame, half, tolerance_m)
                if patch is not None:
                    return patch
    return None


def _half(shapes: tuple[Shape, ...], frame: Frame, share: float) -> tuple[float, float]:
    points = surface_points(shapes)
    sizes = [float(np.ptp(points @ axis)) for axis in (frame.along, frame.across)]
    return (
        share * min(_LARGEST_M[0], 0.3 * sizes[0]),
        share * min(_LARGEST_M[1], 0.35 * sizes[1]),
    )


def _pad(shapes: tuple[Shape, ...], finger: Finger, normal: Array) -> Region:
    frames = [Frame(_middle(finger, shapes, at, normal), normal, finger.along) for at in _PAD_AT]
    return _patch(shapes, frames) or _patch(shapes, frames, _COARSE_M) or fit_point(shapes, frames[0])


def _tip(shapes: tuple[Shape, ...], finger: Finger, normal: Array) -> Region:
    leaning = [np.cos(a) * normal + np.sin(a) * finger.along for a in _TIP_LEANS]
    for axis in leaning[:2]:
        for half_angle in _CAPS:
            cap = fit_cap(shapes, axis, float(half_angle), _TOLERANCE_M)
            if cap is not None:
                return cap
    points = surface_points(shapes)
    frames = []
    for axis in leaning:
        heights = points @ axis
        top = points[heights >= heights.max() - 5e-4].mean(axis=0)
        frames.append(Frame(top, axis, np.cross(np.cross(normal, finger.along), axis)))
    at_end = [Frame(_middle(finger, shapes, at, normal), normal, finger.along) for at in _TIP_AT]
    return (
        _patch(shapes, frames[:2])
        or _patch(shapes, at_end)
        or _patch(shapes, frames)
        or _patch(shapes, [*frames, *at_end], _COARSE_M)
        or fit_point(shapes, at_end[0])
    )


def _sides(hand: Hand, facing: Facing, name: str, finger: Finger, normal: Array) -> dict[str, HandRegion]:
    """The sides that look at other fingers, the one that sees more first."""
    shapes, across = hand.links[finger.last].shapes, np.cross(finger.along, normal)
    found = []
    for direction in (across, -across):
        point = _middle(finger, shapes, 0.6, normal)
        share, _ = facing.seen(finger.last, point, direction, {0, *finger.own})
        frames = [Frame(_middle(finger, shapes, at, normal), direction, finger.along) for at in _PAD_AT]
        region = _patch(shapes, frames) if share > _FACING else None
        if region is not None:
            found.append((share, region))
    found.sort(key=lambda entry: -entry[0])
    names = (f"{name}/side", f"{name}/far_side")
    return {key: HandRegion(key, finger.last, region) for key, (_, region) in zip(names, found, strict=False)}


def _inner(hand: Hand, facing: Facing, name: str, finger: Finger) -> dict[str, HandRegion]:
    """Pads of the links before the last one, where they look at other fingers."""
    out = {}
    for word, link in zip(_INNER, finger.links[1:], strict=False):
        shapes = hand.links[link].shapes
        inner = _inner_frame(hand, facing, link, finger)
        region = None if inner is None else _patch(shapes, [inner])
        if region is not None:
            out[f"{name}/{word}"] = HandRegion(f"{name}/{word}", link, region)
    return out


def _inner_frame(hand: Hand, facing: Facing, link: int, finger: Finger) -> Frame | None:
    """The middle of an inner link on the side that looks at the others; None where it looks at none."""
    child = next(
        i for i in range(len(hand.links)) if hand.links[i].parent == link and _carries(hand, i, finger)
    )
    axes = hand.links[child].axes
    end = hand.links[child].T_parent_link0[:3, 3]
    if not axes or np.linalg.norm(end) < 4e-3 or axes[-1].kind == "prismatic":
        return None
    along = end / np.linalg.norm(end)
    bend = hand.links[child].T_parent_link0[:3, :3] @ axes[-1].direction
    normal = np.cross(bend, along)
    if np.linalg.norm(normal) < 0.5:
        return None
    normal /= np.linalg.norm(normal)
    shares = [facing.seen(link, 0.5 * end, s * normal, finger.own)[0] for s in (1.0, -1.0)]
    if max(shares) <= _FACING:
        return None
    return Frame(0.5 * end, normal if shares[0] >= shares[1] else -normal, along)


def _carries(hand: Hand, link: int, finger: Finger) -> bool:
    other = finger.last
    while other > link:
        other = hand.links[other].parent
    return other == link
