"""Files as their authors' programs write them, made from known poses; shares no code with the readers."""

import io
import json

import h5py
import numpy as np
import yaml
from scipy.spatial.transform import Rotation

N = 5
NAMES = ["FFJ4", "FFJ3", "FFJ2", "THJ5", "THJ4"]


def poses(seed: int = 0, count: int = N) -> np.ndarray:
    """Poses (count, 4, 4) of a hand in the object's frame, in m."""
    rng = np.random.default_rng(seed)
    T = np.tile(np.eye(4), (count, 1, 1))
    T[:, :3, :3] = Rotation.random(count, rng=rng).as_matrix()
    T[:, :3, 3] = rng.uniform(-0.2, 0.2, (count, 3))
    return T


def wxyz(T: np.ndarray) -> np.ndarray:
    return np.roll(Rotation.from_matrix(T[..., :3, :3]).as_quat(), 1, axis=-1)


def joints(seed: int = 1, count: int = N) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0.0, 1.0, (count, len(NAMES)))


def isaac(
    head: dict | None = None, entry: dict | None = None, count: int = N, *, rows: bool = False
) -> bytes:
    T, q = poses(count=count), wxyz(poses(count=count))
    grasps = {
        f"grasp_{i}": {
            "confidence": float(i % 2),
            "position": T[i, :3, 3].tolist(),
            "orientation": q[i].tolist() if rows else {"w": float(q[i, 0]), "xyz": q[i, 1:].tolist()},
            "cspace_position": {"finger_joint": 0.01 * i},
            "pregrasp_cspace_position": {"finger_joint": 0.04},
            **(entry or {}),
        }
        for i in range(count)
    }
    data = {"format": "isaac_grasp", "format_version": 1.0, **(head or {}), "grasps": grasps}
    return yaml.dump({key: value for key, value in data.items() if value != "-"}, sort_keys=False).encode()


def graspgen(**more) -> dict:
    return {
        "object": {"file": "mug.obj", "scale": 0.5},
        "gripper": {
            "name": "franka_panda",
            "file_name": "franka.usd",
            "width": 0.08,
            "depth": 0.1,
            "transform_offset_from_asset_to_graspgen_convention": [[0, 0, 0], [0, 0, 0, 1]],
        },
        "grasps": {
            "transforms": poses().tolist(),
            "object_in_gripper": [i % 2 == 0 for i in range(N)],
            "score": [0.1 * i for i in range(N)],
            **more,
        },
    }


def multigripper(**more) -> dict:
    rows = np.concatenate([poses()[:, :3, 3], wxyz(poses())], axis=1)
    return {
        "gripper": "Allegro",
        "object_id": "mug",
        "pose": rows.tolist(),
        "dofs": joints().tolist(),
        "fall_time": [3.0000002, 0.5, 0.0, 3.0, 1.0],
        **more,
    }


def keyed(column: list) -> dict:
    return {str(i): row for i, row in enumerate(column)}


def acronym(transforms: np.ndarray | None = None, names: str = "grasps/transforms") -> bytes:
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        file[names] = poses() if transforms is None else transforms
        file["grasps/qualities/flex/object_in_gripper"] = np.array([1, 0, 1, 0, 1])
        file["gripper/type"] = "panda"
        file["gripper/configuration"] = [0.04]
        file["object/file"] = "meshes/Mug/x.obj"
        file["object/scale"] = 0.001
        file["object/mass"] = 0.2
    return buffer.getvalue()


def saved(value, *, allow_pickle: bool = True, **names) -> bytes:
    buffer = io.BytesIO()
    if names:
        np.savez(buffer, **names)
    else:
        np.save(buffer, value, allow_pickle=allow_pickle)
    return buffer.getvalue()


def dexgraspnet_qpos(i: int) -> dict:
    euler = Rotation.from_matrix(poses()[i, :3, :3]).as_euler("xyz")  # fixed axes
    position = poses()[i, :3, 3]
    named = dict(zip((f"robot0:{name}" for name in NAMES), joints()[i].tolist(), strict=True))
    named |= dict(zip(("WRJRx", "WRJRy", "WRJRz"), euler.tolist(), strict=True))
    return named | dict(zip(("WRJTx", "WRJTy", "WRJTz"), position.tolist(), strict=True))


def dexgraspnet(scale: float = 0.08) -> list[dict]:
    return [{"qpos": dexgraspnet_qpos(i), "scale": np.float64(scale), "E_pen": 0.01 * i} for i in range(N)]


def rows() -> np.ndarray:
    """Position, quaternion (w first) and joints of each grasp (N, 7 + k)."""
    return np.concatenate([poses()[:, :3, 3], wxyz(poses()), joints()], axis=1)


def dexgraspbench(i: int | None = None, **more) -> dict:
    row = rows() if i is None else rows()[i]
    return {
        "obj_pose": np.array([0.0, 0, 0, 1, 0, 0, 0]),
        "obj_scale": 0.06,
        "obj_path": "assets/object/mug",
        "pregrasp_qpos": row.astype(np.float64) + np.concatenate([np.zeros(7), np.full(len(NAMES), -0.1)]),
        "grasp_qpos": row,
        "squeeze_qpos": row + np.concatenate([np.zeros(7), np.full(len(NAMES), 0.1)]),
        **more,
    }


def graspit() -> bytes:
    """A world whose hand on an arm stands at pose 1, and whose body stands at pose 0."""

    def transform(T: np.ndarray) -> str:
        w, x, y, z = wxyz(T)
        words = " ".join(f"{1e3 * v:+.9f}" for v in T[:3, 3])
        return (
            "<transform><fullTransform>"
            f"({w:+.12f} {x:+.12f} {y:+.12f} {z:+.12f})[{words}]</fullTransform></transform>"
        )

    body, hand = poses()[0], poses()[0] @ poses()[1]
    return f"""<?xml version="1.0" ?>
<world>
  <obstacle><filename>models/table.xml</filename>{transform(np.eye(4))}</obstacle>
  <graspableBody><filename>models/objects/mug.xml</filename>{transform(body)}</graspableBody>
  <robot><filename>models/robots/Puma/Puma.xml</filename><dofValues>0 1 2</dofValues>
    {transform(np.eye(4))}</robot>
  <robot><filename>models/robots/Barrett/Barrett.xml</filename>
    <dofValues>+0.1 +0.9 +0 +0 +0.8 +0 +0</dofValues>{transform(hand)}</robot>
  <connection><parentRobot>0</parentRobot><parentChain>0</parentChain><childRobot>1</childRobot></connection>
</world>""".encode()


def simox(unit: str = "radian", *, angles: bool = False) -> bytes:
    """Poses of the object in the hand's frame, mm."""
    value = np.rad2deg(0.5) if unit == "degree" else 0.5
    grasps = []
    for i, T in enumerate(np.linalg.inv(poses())):
        T[:3, 3] *= 1e3
        lines = "".join(
            f"<row{r + 1} " + " ".join(f"c{c + 1}='{T[r, c]:.12g}'" for c in range(4)) + "/>"
            for r in range(4)
        )
        place = f"<Matrix4x4>{lines}</Matrix4x4>"
        if angles:
            x, y, z = T[:3, 3]
            roll, pitch, yaw = Rotation.from_matrix(T[:3, :3]).as_euler("xyz", degrees=True)
            place = f"<Translation x='{x:.12g}' y='{y:.12g}' z='{z:.12g}'/><rollpitchyaw unitsAngle='degree' "
            place += f"roll='{roll:.15g}' pitch='{pitch:.15g}' yaw='{yaw:.15g}'/>"
        grasps.append(
            f"<Grasp name='Grasp {i}' quality='0.{i}' Creation='x'><Transform>{place}"
            f"</Transform><Configuration name='c'><Node name='Thumb' unit='{unit}' value='{value}'/>"
            "</Configuration></Grasp>"
        )
    return (
        "<ManipulationObject name='Mug'><Visualization><File type='inventor'>iv/mug.iv</File></Visualization>"
        f"<GraspSet name='s' RobotType='Armar3' EndEffector='Hand L'>{''.join(grasps)}</GraspSet>"
        "</ManipulationObject>"
    ).encode()


def billion() -> np.ndarray:
    T = poses()
    head = np.tile([0.7, 0.06, 0.02, 0.03], (N, 1))
    return np.concatenate([head, T[:, :3, :3].reshape(N, 9), T[:, :3, 3], np.arange(N)[:, None]], axis=1)


def as_json(value) -> bytes:
    return json.dumps(value).encode()
