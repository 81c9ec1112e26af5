"""Four craft, in plain numbers of a builder's sheet; SI, x ahead of midship, y to starboard.

Sources: catamaran: the Otter of Maritime Robotics (2 m, 55 kg, two fixed thrusters) by its published
particulars; ferry4: milliAmpere (5 m, four azimuths; Pedersen 2019); ferry2 and jet: estimates of ours for a
45 m double-shaft ferry and an 8 m work boat below its hump. Coefficients of section drag 0.6 to 1.1 (Hoerner
1965), of residuary resistance by Froude number estimates of ours.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """One actuator. kind: thruster, pod, jet, tunnel or shaft (a screw with a rudder behind it).

    pitch: way of the screw in one turn without slip [m]; n_max [1/s]; lag [s] of its motor; servo [rad/s] of
    its angle; astern: share of the push that is left when it turns back; records: what is written down of
    it."""

    name: str
    kind: str
    x: float
    y: float
    D: float
    pitch: float
    n_max: float
    records: tuple[str, ...]
    lag: float = 0.15
    servo: float = 0.8
    angle_max: float = 0.6
    astern: float = 0.65
    rudder: float = 0.0  # area [m2]
    grip: float = 0.8  # push of the real screw over that of one without losses


@dataclass(frozen=True)
class Craft:
    """One hull, or two alike at +-`apart`/2 from the centreline."""

    name: str
    L: float
    B: float
    T: float
    m: float
    U0: float
    wetted: float  # [m2]
    drives: tuple[Drive, ...]
    apart: float = 0.0
    x_G: float = 0.0
    k_zz: float = 0.25  # of L
    form: float = 0.15  # k of (1 + k) C_F
    residuary: tuple[tuple[float, float], ...] = (
        (0.0, 0.0),
        (0.2, 5e-4),
        (0.3, 1.5e-3),
        (0.5, 4e-3),
        (0.8, 5e-3),
    )
    section_drag: float = 0.8
    transom: float = 0.4  # share of a midship section's depth that is left at the stern
    skeg: float = 0.95  # the same with its skeg, where what the hull lifts is shed
    air: tuple[float, float] = (1.0, 2.0)  # frontal and lateral area [m2]
    # of position [m], speed [m/s], heading [deg], rate of turn [deg/s], log [m/s]
    noise: tuple[float, ...] = (0.02, 0.015, 0.2, 0.15, 0.02)
    rho: float = 1025.0


def _pod(name: str, x: float, y: float) -> Drive:
    return Drive(name, "pod", x, y, 0.3, 0.26, 14.0, ("rate_rpm", "angle_deg"), 0.4, 0.9, 3.2, grip=0.75)


def _screw(name: str, y: float) -> Drive:
    return Drive(
        name, "shaft", -20.0, y, 1.6, 1.7, 5.6, ("rate_rpm", "angle_deg"), 2.0, 0.08, 0.6, rudder=2.4
    )


def _jet(name: str, y: float) -> Drive:
    return Drive(name, "jet", -3.8, y, 0.13, 0.42, 34.0, ("rate_rpm", "angle_deg"), 0.3, 1.2, 0.45)


def _side(name: str, y: float) -> Drive:
    return Drive(name, "thruster", -0.75, y, 0.19, 0.15, 22.0, ("pwm_us",), 0.12)


CRAFT = {
    c.name: c
    for c in (
        Craft(
            "catamaran", 2.0, 1.08, 0.19, 55.0, 2.0, 1.9, (_side("port", -0.4), _side("starboard", 0.4)),
            apart=0.77, x_G=0.05, skeg=0.6, air=(0.3, 0.6),
        ),
        Craft(
            "ferry2", 45.0, 10.5, 2.6, 560e3, 5.0, 480.0,
            (
                _screw("port", -2.8), _screw("starboard", 2.8),
                Drive("bow", "tunnel", 17.0, 0.0, 0.9, 0.8, 7.5, ("command",), 1.0),
            ),
            form=0.2, air=(70.0, 260.0), noise=(0.3, 0.03, 0.1, 0.03, 0.04),
        ),
        Craft(
            "ferry4", 5.0, 2.8, 0.3, 1800.0, 1.8, 13.0,
            (_pod("fore_port", 1.8, -0.8), _pod("fore_starboard", 1.8, 0.8),
             _pod("aft_port", -1.8, -0.8), _pod("aft_starboard", -1.8, 0.8)),
            form=0.3, section_drag=0.9, transom=0.9, air=(6.0, 10.0),
        ),
        Craft(
            "jet", 8.0, 2.6, 0.5, 3600.0, 5.5, 19.0, (_jet("port", -0.5), _jet("starboard", 0.5)),
            x_G=-0.5, transom=0.8, skeg=0.85, air=(5.0, 12.0), noise=(0.05, 0.02, 0.2, 0.1, 0.03),
        ),
    )
}  # fmt: skip
"""The craft by name."""
