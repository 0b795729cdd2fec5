"""Which bodies a compiled model keeps from touching."""

import mujoco

__all__ = ["never_touching"]


def never_touching(m: mujoco.MjModel, colliding: dict[int, list[int]]) -> list[tuple[int, int]]:
    """Pairs of bodies that the model keeps from touching, by excludes or by the bits of their geoms.

    Args:
        m: the model.
        colliding: the geoms of each body that collide.

    Returns:
        Pairs in the order of `colliding`. A pair of geoms that is named as such touches all the same.
    """
    excluded = {tuple(sorted((int(s) >> 16, int(s) & 0xFFFF))) for s in m.exclude_signature}
    paired = {
        tuple(sorted((int(m.geom_bodyid[a]), int(m.geom_bodyid[b]))))
        for a, b in zip(m.pair_geom1, m.pair_geom2, strict=True)
    }
    bits = {
        body: {(int(m.geom_contype[g]), int(m.geom_conaffinity[g])) for g in geoms}
        for body, geoms in colliding.items()
    }
    kept, out = list(colliding), list[tuple[int, int]]()
    for i, a in enumerate(kept):
        for b in kept[i + 1 :]:
            by_bits = (
                bits[a]
                and bits[b]
                and not any(
                    (t & affinity) | (other & own) for t, own in bits[a] for other, affinity in bits[b]
                )
            )
            key = tuple(sorted((a, b)))
            if key not in paired and (key in excluded or by_bits):
                out.append((a, b))
    return out
