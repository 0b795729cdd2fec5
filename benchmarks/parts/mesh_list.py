"""The meshes of `benchmarks/meshes.py`: what packages of the Python package index ship, hand-sized things.

The list was written down before anything was tuned to it. Of its two halves the first was looked at while the
search for contacts was made, the second (`unseen`) was not.
"""

from typing import NamedTuple

__all__ = ["MESHES", "VERSIONS", "Source"]

VERSIONS = {"metaworld": "3.1.1", "pybullet": "3.2.7", "robosuite": "1.5.2"}
_FOLDERS = {
    "metaworld": "metaworld/assets/objects/meshes",
    "pybullet": "pybullet_data",
    "robosuite": "robosuite/models/assets/objects/meshes",
}


class Source(NamedTuple):
    """A mesh in a package.

    Attributes:
        package: name on the index.
        path: of the file below the package's folder of meshes.
        scale: metres to a unit of the file; what is modelled larger than any hand is made 3 to 13 cm.
        is_unseen: whether it belongs to the half that was kept aside.
    """

    package: str
    path: str
    scale: float
    is_unseen: bool

    @property
    def member(self) -> str:
        """Path inside the wheel."""
        return f"{_FOLDERS[self.package]}/{self.path}"

    @property
    def name(self) -> str:
        """A name for tables and files."""
        return f"{self.package}-{self.path.rpartition('/')[2].replace('.', '-')}"


_SEEN = {
    "metaworld": {
        "assembly_peg/assembly_peg_ring.stl": 1.0,
        "basketball/basketballouter.stl": 1.0,
        "box/boxhandle.stl": 1.0,
        "coffeemachine/mug.stl": 1.0,
        "dial/dial.stl": 1.0,
        "doorlock/handle.stl": 1.0,
        "faucet/faucethead.stl": 1.0,
        "hammer/hammerhead.stl": 1.0,
        "plug/plug_head.stl": 1.0,
        "stick/stick.stl": 1.0,
        "thermos/therm_cap.stl": 1.0,
    },
    "pybullet": {
        "differential/diff_carrier.stl": 1e-3,
        "duck.obj": 0.05,
        "lego/lego.obj": 0.2,
        "objects/mug.obj": 1.0,
        "random_urdfs/000/000.obj": 0.01,
        "random_urdfs/104/104.obj": 0.01,
        "random_urdfs/259/259.obj": 0.01,
        "teddy2_VHACD_CHs.obj": 0.1,
        "torus/torus_textured.obj": 0.05,
    },
    "robosuite": {"bottle.stl": 1.0, "can.stl": 1.0, "cereal.stl": 1.0, "milk.obj": 1.0},
}
_UNSEEN = {
    "metaworld": {
        "assembly_peg/assembly_peg_handle.stl": 1.0,
        "buttonbox/buttonring.stl": 1.0,
        "coffeemachine/cup.stl": 1.0,
        "dial/dialhead.stl": 1.0,
        "drawer/drawerhandle.stl": 1.0,
        "golf_club/club_head.stl": 1.0,
        "hammer/nail.stl": 1.0,
        "lever/lever_handle.stl": 1.0,
        "puck/puck.stl": 1.0,
        "thermos/therm_handle.stl": 1.0,
    },
    "pybullet": {
        "bunny.obj": 0.05,
        "differential/diff_pinion.stl": 1e-3,
        "duck_vhacd.obj": 0.05,
        "l_finger_tip.stl": 1.0,
        "objects/mug_col.obj": 1.0,
        "random_urdfs/038/038.obj": 0.01,
        "random_urdfs/055/055.obj": 0.01,
        "random_urdfs/713/713.obj": 0.01,
        "random_urdfs/835/835.obj": 0.01,
        "textured_sphere_smooth.obj": 0.03,
        "toys/prism.obj": 1.0,
    },
    "robosuite": {"bread.stl": 1.0, "can.obj": 1.0, "handles.stl": 0.3, "lemon.stl": 1.0},
}

MESHES = tuple(
    Source(package, path, scale, is_unseen)
    for half, is_unseen in ((_SEEN, False), (_UNSEEN, True))
    for package, files in half.items()
    for path, scale in files.items()
)
