"""Which body of a model is the palm, also where the model is a whole robot."""

import warnings

import numpy as np

from ...base.numeric.arrays import Array
from ...errors import InputError, InputWarning, UnknownName
from .model_tree import IMPORTED_KINDS, ModelTree

__all__ = ["find_palm_body", "warn_of_limbs"]

# What hangs on a body by so many joints, so far away or movable so far, and branches there, is an arm with a
# hand.
_ARM_JOINTS, _ARM_M = 3, 0.2
# A chain of so many joints is no finger.
_JAW_JOINTS = 5
# What reaches further from the palm without branching is an arm or a leg, for fingers are shorter.
_LONGEST_FINGER_M = 0.4


def find_palm_body(tree: ModelTree, name: str | None, source: str) -> int:
    """Number of the body called `name`; unless named, of the one that carries the fingers.

    Where several fingers stand on the world, each on a joint of its own, the world is the palm. Of several
    bodies on the world it is the only one that has fingers: the others are what a scene holds besides.

    Args:
        tree: the model, whose notes take what was chosen.
        name: as the hand file gives it.
        source: the file, for error messages.

    Raises:
        InputError: no such body, or several to choose from.
    """
    if name is not None:
        if name not in tree.body_names:
            raise UnknownName(source, "palm", "body", name, tree.body_names)
        return tree.body_names.index(name)
    palm = _found_palm(tree, source)
    hands = _hands(tree, palm) if palm != 0 else [palm]
    if len(hands) > 1:
        raise _which_hand(tree, hands, source, "this is a robot with")
    if hands[0] != palm:
        palm = hands[0]
        tree.notes.append(
            f"the model is a whole robot: the palm is {tree.body_names[palm]}, the only hand that was found"
        )
    return palm


def _which_hand(tree: ModelTree, hands: list[int], source: str, what: str) -> InputError:
    found = ", ".join(tree.body_names[body] for body in hands)[:300]
    return InputError(
        source,
        "palm",
        f"is required: {what} {len(hands)} hands; name one of their palms in a hand file that imports it: "
        f"{found}",
    )


def _found_palm(tree: ModelTree, source: str) -> int:
    """The body that carries all that moves in parallel: the palm, unless the model is a whole robot."""
    roots = [i for i in range(1, tree.n_bodies) if tree.parents[i] == 0]
    if len(roots) == 1:
        return _before_fingers(tree, roots[0])
    if len(roots) > 1 and all(tree.kinds(body) and tree.kinds(body) <= set(IMPORTED_KINDS) for body in roots):
        tree.notes.append("several fingers stand on the world: the world is the palm")
        return 0
    with_fingers = [root for root in roots if _has_fingers(tree, root)]
    if len(with_fingers) == 1:
        others = ", ".join(tree.body_names[root] for root in roots if root not in with_fingers)[:300]
        tree.notes.append(
            f"of the bodies on the world only {tree.body_names[with_fingers[0]]} has fingers; "
            f"left out: {others}"
        )
        return _before_fingers(tree, with_fingers[0])
    if with_fingers:
        hands = [hand for root in with_fingers for hand in _hands(tree, _where_fingers_branch(tree, root))]
        raise _which_hand(tree, hands, source, "on the world stand")
    found = ", ".join(tree.body_names[body] for body in roots)[:300]
    what = f"several bodies stand on the world: {found}" if roots else "no body stands on the world"
    raise InputError(
        source,
        "palm",
        f"is required: {what}; name the palm, or world if it is part of the world",
    )


def _has_fingers(tree: ModelTree, root: int) -> bool:
    """Whether several chains of bodies move against one below the root."""
    moving = [i for i in _movable(tree) if i != root and _is_below(tree, i, root)]
    above = [_first_moving_above(tree, i) for i in moving]
    return any(above.count(body) > 1 for body in above)


def _movable(tree: ModelTree) -> list[int]:
    return [i for i in range(1, tree.n_bodies) if tree.kinds(i) & set(IMPORTED_KINDS)]


def _is_below(tree: ModelTree, body: int, root: int) -> bool:
    while body > root:  # parents come first
        body = tree.parents[body]
    return body == root


def _before_fingers(tree: ModelTree, root: int) -> int:
    """`_where_fingers_branch`, with a note where that is not the root."""
    body = _where_fingers_branch(tree, root)
    if body == root:
        return root
    jaws = _moving_below(tree, body)
    if len(jaws) == 1:
        tree.notes.append(
            f"the model is an arm with a gripper of one jaw, {tree.body_names[jaws[0]]}: the palm is "
            f"{tree.body_names[body]}, which carries it"
        )
        return body
    tree.notes.append(
        f"the palm is {tree.body_names[body]}, from which the fingers branch; what carries it is left out"
    )
    return body


def _where_fingers_branch(tree: ModelTree, root: int) -> int:
    """The body from which fingers branch, or that carries a gripper's only jaw; else the root."""
    body = root
    while len(below := _moving_below(tree, body)) == 1:
        body = below[0]
    if below:
        return body
    return _first_moving_above(tree, body) if _is_arm_with_a_jaw(tree, root, body) else root


def _moving_below(tree: ModelTree, body: int) -> list[int]:
    """The next bodies below one that move against it."""
    return [
        i
        for i in range(1, tree.n_bodies)
        if tree.kinds(i) and i != body and _first_moving_above(tree, i) == body
    ]


def _is_arm_with_a_jaw(tree: ModelTree, root: int, last: int) -> bool:
    """Whether a chain without branches is an arm whose last joint moves a jaw, not a wrist."""
    joints = sum(bool(tree.kinds(i)) for i in range(root, last + 1) if _is_below(tree, last, i))
    far_m = _way_m(tree, _positions(tree), last, root)
    return joints >= _JAW_JOINTS and far_m >= _ARM_M and tree.is_a_jaws(last)


def _first_moving_above(tree: ModelTree, body: int) -> int:
    """The nearest body above that moves against its parent, or the one that stands on the world."""
    body = tree.parents[body]
    while tree.parents[body] != 0 and not tree.kinds(body):
        body = tree.parents[body]
    return body


def _hands(tree: ModelTree, body: int) -> list[int]:
    """The palms of a robot whose limbs branch from a body: that body alone where they are fingers."""
    above = {i: _first_moving_above(tree, i) for i in _movable(tree)}
    children: dict[int, list[int]] = {}
    for i, parent in above.items():
        children.setdefault(parent, []).append(i)
    at = _positions(tree)
    found: list[int] = []
    # How far a chain leads is how far its furthest joint is, for an arm may hang down beside the body.
    below = [(child, 1, tree.travel_m(child), 0.0) for child in children.get(body, [])]
    while below:
        i, joints, travel_m, far_m = below.pop(0)
        own = children.get(i, [])
        far_m = max(far_m, float(np.linalg.norm(at[i] - at[body])))
        if len(own) > 1 and joints >= _ARM_JOINTS and travel_m + far_m >= _ARM_M:
            found += _hands(tree, i)
        else:
            below += [(child, joints + 1, travel_m + tree.travel_m(child), far_m) for child in own]
    return found or [body]


def warn_of_limbs(tree: ModelTree, palm: int, source: str) -> None:
    """Warns of chains that are longer than fingers, with the field that chooses another palm."""
    at = _positions(tree)
    lengths_m = {
        i: _way_m(tree, at, i, _first_of_chain(tree, i, palm))
        for i in _movable(tree)
        if i != palm and _is_below(tree, i, palm)
    }
    furthest = max(lengths_m, key=lambda i: lengths_m[i], default=palm)
    if lengths_m.get(furthest, 0.0) > _LONGEST_FINGER_M:
        said = (
            f"{tree.body_names[palm]} was taken for the palm, and what it carries is "
            f"{lengths_m[furthest]:.2g} m long up to {tree.body_names[furthest]}: is this a robot without a "
            "hand, or one whose palm has to be named by `palm` in a hand file?"
        )
        warnings.warn(InputWarning(source, "palm", said), stacklevel=2)


def _first_of_chain(tree: ModelTree, body: int, palm: int) -> int:
    """The body nearest to the palm that moves on the way to another one."""
    first = body
    while (
        (above := _first_moving_above(tree, first)) != palm
        and tree.kinds(above)
        and _is_below(tree, above, palm)
    ):
        first = above
    return first


def _way_m(tree: ModelTree, at: dict[int, Array], body: int, above: int) -> float:
    """How long the chain of bodies is from one to another above it, in m, however it is folded."""
    way_m = 0.0
    while body not in (above, 0):
        parent = tree.parents[body]
        way_m += float(np.linalg.norm(at[body] - at[parent]))
        body = parent
    return way_m


def _positions(tree: ModelTree) -> dict[int, Array]:
    """Origins of all bodies as the model places them, in m."""
    placed = {0: np.eye(4)}
    for i in range(1, tree.n_bodies):  # parents come first
        placed[i] = placed[tree.parents[i]] @ tree.T_placed(i)
    return {i: T[:3, 3] for i, T in placed.items()}
