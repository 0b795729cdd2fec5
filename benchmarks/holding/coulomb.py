"""At which share of Coulomb's critical load MuJoCo lets pinched bodies slip, with our settings and its own.

Usage: ./run bench coulomb [--seconds S]

Fingers on sliders press a body with 20 N each; a force along their faces, or a torque about the line of a
pinch, acts on it. By Coulomb's law it slips from friction times the sum of the normal forces on, spins from
torsional friction times that sum, and under both from where their shares' squares add up to one. The body
slips if it passes the limits of the hold test within the time given; found by bisection. Beside it stands how
fast the body creeps under half its critical load. Settings come from the presets as they are.
"""

import argparse
from dataclasses import dataclass

import mujoco
import numpy as np
from holdfast.base.text.console import format_table
from holdfast.mjcf import HoldSettings, preset_settings
from holdfast.objects import load_task

FORCE_N, FRICTION, ARM_M, MASS_KG, SIZE_M = 20.0, 0.6, 0.003, 0.1, 0.012
PRESETS = ("holdfast", "no_noslip")
SETTLE_S, RAMP_S, RESOLUTION = 0.3, 0.2, 0.005
LOWEST, HIGHEST = 0.0, 1.5
BODIES = {
    "sphere": f'type="sphere" size="{SIZE_M}"',
    "box": f'type="box" size="{SIZE_M} {SIZE_M} {SIZE_M}"',
}


@dataclass(frozen=True)
class Pinch:
    """A body between fingers, and the direction of its load in (pull, spin).

    Attributes:
        body: `sphere` or `box`.
        fingers: how many press it, evenly around z.
        pull: share of the critical force along z.
        spin: share of the critical torque about x.
    """

    body: str
    fingers: int
    pull: float
    spin: float


PINCHES = {
    "sphere, pulled": Pinch("sphere", 2, 1.0, 0.0),
    "box, pulled": Pinch("box", 2, 1.0, 0.0),
    "sphere, spun": Pinch("sphere", 2, 0.0, 1.0),
    "sphere, pulled and spun": Pinch("sphere", 2, 0.5**0.5, 0.5**0.5),
    "tripod, pulled": Pinch("sphere", 3, 1.0, 0.0),
}


def model_of(pinch: Pinch, settings: HoldSettings | None) -> mujoco.MjModel:
    """The pinch with the solver and contacts of a hold test; None for MuJoCo's defaults.

    Fingers touch the body alone, not each other.
    """
    option = contact = ""
    if settings is not None:
        option = (
            f'cone="elliptic" jacobian="dense" integrator="implicitfast" solver="{settings.solver}" '
            f'timestep="{settings.timestep_s}" impratio="{settings.impratio}" '
            f'noslip_iterations="{settings.noslip_iterations}"'
        )
        solref, solimp = (" ".join(map(str, v)) for v in (settings.contact_solref, settings.contact_solimp))
        contact = f'solref="{solref}" solimp="{solimp}"'
    fingers = ""
    for k in range(pinch.fingers):
        angle = 2.0 * np.pi * k / pinch.fingers
        x, y = np.cos(angle), np.sin(angle)
        at = SIZE_M + 0.01
        fingers += (
            f'<body pos="{at * x} {at * y} 0" euler="0 0 {angle}">'
            f'<joint name="slide{k}" type="slide" axis="-1 0 0" damping="5" armature="0.05"/>'
            '<geom type="box" size="0.01 0.03 0.06" mass="0.05" contype="1" conaffinity="2"/></body>'
        )
    motors = "".join(f'<motor joint="slide{k}"/>' for k in range(pinch.fingers))
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco><compiler angle="radian"/><option gravity="0 0 0" {option}/>
        <default><geom condim="4" friction="{FRICTION} {FRICTION * ARM_M} 0.0001" {contact}/></default>
        <worldbody>
        <body name="thing"><freejoint/>
        <geom {BODIES[pinch.body]} mass="{MASS_KG}" contype="2" conaffinity="1"/>
        </body>{fingers}
        </worldbody>
        <actuator>{motors}</actuator></mujoco>""")


def motion(
    pinch: Pinch, settings: HoldSettings | None, share: float, seconds: float
) -> tuple[bool, float, float]:
    """Whether the body slips under a share of its critical load; how far it went in m, and turned in rad."""
    limits = settings or HoldSettings()
    model = model_of(pinch, settings)
    data = mujoco.MjData(model)
    data.ctrl[:] = FORCE_N
    critical = pinch.fingers * FRICTION * FORCE_N
    load = critical * share * np.array([0.0, 0.0, pinch.pull, ARM_M * pinch.spin, 0.0, 0.0])
    body = model.body("thing").id
    _run(model, data, SETTLE_S)
    for part in np.linspace(0.0, 1.0, 20):
        data.xfrc_applied[body] = part * load
        _run(model, data, RAMP_S / 20)
    _run(model, data, SETTLE_S)
    start, R = data.qpos[:3].copy(), data.qpos[3:7].copy()
    went = turned = 0.0
    for _ in range(round(seconds / 0.02)):
        _run(model, data, 0.02)
        turn = np.zeros(3)
        mujoco.mju_subQuat(turn, data.qpos[3:7], R)
        went, turned = float(np.linalg.norm(data.qpos[:3] - start)), float(np.linalg.norm(turn))
        if went > limits.slip_limit_m or turned > (limits.rotation_limit_rad or np.inf):
            return True, went, turned
    return False, went, turned


def _run(model: mujoco.MjModel, data: mujoco.MjData, seconds: float) -> None:
    mujoco.mj_step(model, data, nstep=max(1, round(seconds / model.opt.timestep)))


def critical_share(pinch: Pinch, settings: HoldSettings | None, seconds: float) -> tuple[float, float]:
    """The largest share of the critical load that was seen to hold, and the smallest to slip."""
    low, high = LOWEST, HIGHEST
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        if motion(pinch, settings, middle, seconds)[0]:
            high = middle
        else:
            low = middle
    return low, high


def all_settings() -> dict[str, HoldSettings | None]:
    """The settings that are measured, by name."""
    task = load_task("upholding")
    return {name: preset_settings(name, task) for name in PRESETS} | {"MuJoCo's defaults": None}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=2.0, help="under the load")
    seconds = parser.parse_args().seconds
    rows = []
    for name, settings in all_settings().items():
        for title, pinch in PINCHES.items():
            low, high = critical_share(pinch, settings, seconds)
            _, went, turned = motion(pinch, settings, 0.5, seconds)
            creep = f"{1e6 * went / seconds:.1f} um/s, {np.degrees(turned) / seconds:.4f} deg/s"
            rows.append((name, title, f"{low:.3f}", f"{high:.3f}", creep))
    print(format_table(("settings", "pinch", "holds at", "slips at", "creep at half the load"), rows))
    print("shares of the critical load by Coulomb's law")


if __name__ == "__main__":
    main()
