"""Which body of a model is the palm."""

from ...errors import InputError, UnknownName
from .model_tree import IMPORTED_KINDS, ModelTree

__all__ = ["find_palm_body"]


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
    """The body from which fingers branch, above which are a wrist or an arm; else the root."""
    moving = [i for i in range(1, tree.n_bodies) if tree.kinds(i)]
    body = root
    while True:
        below = [i for i in moving if i != body and _first_moving_above(tree, i) == body]
        if len(below) != 1:
            break
        body = below[0]
    if not below or body == root:
        return root
    tree.notes.append(
        f"the palm is {tree.body_names[body]}, from which the fingers branch; what carries it is left out"
    )
    return body


def _first_moving_above(tree: ModelTree, body: int) -> int:
    """The nearest body above that moves against its parent, or the one that stands on the world."""
    body = tree.parents[body]
    while tree.parents[body] != 0 and not tree.kinds(body):
        body = tree.parents[body]
    return body
