"""ROS messages as quantities: one function a type, of message and frame to (part, quantity, value).

ROS counts a heading anticlockwise from east (ENU) and has y to port, z up in the body (FLU: REP 103); a
`frame_id` that names NED or FRD says otherwise. Here all become north, east, down and ahead, starboard, down.
"""

from collections.abc import Callable, Iterator
from math import atan2, degrees
from typing import Any

MOST_NUMBERS = 16  # of a list in a message of another type
Part = tuple[str, str, float]
DOWN = ("ned", "frd", "fsd")
BODY = ("base", "body", "link", "fcu", "hull", "vessel", "imu")
EARTH = ("map", "odom", "enu", "world", "earth", "utm", "gps", "local")


def is_down(frame: str) -> bool:
    """Whether a frame's name says that its z points down."""
    return any(word in frame.lower() for word in DOWN)


def is_body(frame: str) -> bool:
    """Whether a frame's name says that its axes are the ship's."""
    return any(word in frame.lower() for word in (*BODY, "frd", "fsd", "flu"))


def is_earth(frame: str) -> bool:
    """Whether a frame's name says that its axes are fixed to the earth."""
    return any(word in frame.lower() for word in (*EARTH, "ned"))


def frame_of(message: Any) -> str:
    """The frame that a message's header names; "": none."""
    return str(getattr(getattr(message, "header", None), "frame_id", ""))


def yaw_roll(q: Any) -> tuple[float, float]:
    """Yaw about z and roll about x [deg] of a quaternion."""
    yaw = atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    roll = atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    return degrees(yaw), degrees(roll)


def attitude(q: Any, down: bool) -> Iterator[Part]:
    """True heading and roll [deg] of a quaternion; none of one that is all zeros."""
    if q.x == q.y == q.z == q.w == 0.0:
        return
    yaw, roll = yaw_roll(q)
    yield "heading", "heading_true_north_deg", (yaw if down else 90.0 - yaw) % 360.0
    yield "roll", "roll_deg", roll


def place(p: Any, down: bool) -> Iterator[Part]:
    """Position [m], north and east, of one that counts north and east or east and north."""
    yield "north", "north_m", p.x if down else p.y
    yield "east", "east_m", p.y if down else p.x


def body_velocity(t: Any, down: bool) -> Iterator[Part]:
    """Velocity ahead and to starboard [m/s], and yaw rate [deg/s]."""
    yield "surge", "surge_velocity_mps", t.linear.x
    yield "sway", "sway_velocity_mps", t.linear.y if down else -t.linear.y
    yield "rate", "yaw_rate_degps", degrees(t.angular.z if down else -t.angular.z)


def fix(m: Any, frame: str) -> Iterator[Part]:
    """Latitude and longitude [deg], if there is a fix."""
    if m.status.status >= 0:
        yield "latitude", "latitude_deg", m.latitude
        yield "longitude", "longitude_deg", m.longitude


def odometry(m: Any, frame: str) -> Iterator[Part]:
    """Position, heading and velocity, as its two frames have them."""
    down = is_down(frame)
    yield from place(m.pose.pose.position, down)
    yield from attitude(m.pose.pose.orientation, down)
    yield from body_velocity(m.twist.twist, down or is_down(m.child_frame_id))


def imu(m: Any, frame: str) -> Iterator[Part]:
    """Heading and roll, where there is an attitude, and yaw rate."""
    down = is_down(frame)
    if m.orientation_covariance[0] >= 0.0:
        yield from attitude(m.orientation, down)
    yield "rate", "yaw_rate_degps", degrees(m.angular_velocity.z if down else -m.angular_velocity.z)


def pose(m: Any, frame: str) -> Iterator[Part]:
    """Position and heading, with a covariance or without."""
    inner = m.pose.pose if hasattr(m.pose, "pose") else m.pose
    yield from place(inner.position, is_down(frame))
    yield from attitude(inner.orientation, is_down(frame))


def quaternion(m: Any, frame: str) -> Iterator[Part]:
    """Heading and roll."""
    yield from attitude(m.quaternion, is_down(frame))


def twist(m: Any, frame: str) -> Iterator[Part]:
    """Velocity, in the axes that the frame names."""
    inner = m.twist.twist if hasattr(m.twist, "twist") else m.twist
    if is_body(frame):
        yield from body_velocity(inner, is_down(frame))
    elif is_earth(frame):
        down = is_down(frame)
        yield "velocity_north", "velocity_north_mps", inner.linear.x if down else inner.linear.y
        yield "velocity_east", "velocity_east_mps", inner.linear.y if down else inner.linear.x
    else:
        yield from numbers(inner)


def numbers(m: Any, depth: int = 3) -> Iterator[Part]:
    """Every plain number of a message by its path, for a map to choose from."""
    for name in getattr(m, "__dataclass_fields__", ()):
        value = getattr(m, name)
        if name in ("header", "stamp", "__msgtype__") or name.isupper() or isinstance(value, bool):
            continue
        if isinstance(value, int | float):
            yield name, "", float(value)
        elif depth and hasattr(value, "__dataclass_fields__") and name != "layout":
            for inner, quantity, x in numbers(value, depth - 1):
                yield f"{name}.{inner}", quantity, x
        elif "covariance" not in name and is_short(value):
            for i, x in enumerate(value):
                yield f"{name}_{i + 1}", "", float(x)


def is_short(value: Any) -> bool:
    """Whether a value is a short list of numbers: of thrusters, motors, servos."""
    if isinstance(value, str | bytes) or not hasattr(value, "__len__") or not 0 < len(value) <= MOST_NUMBERS:
        return False
    return all(isinstance(x, int | float) or getattr(x, "dtype", None) is not None for x in value)


def joints(m: Any, frame: str) -> Iterator[Part]:
    """Angles [rad], rates [rad/s] and efforts of joints, each by its name, of no channel yet."""
    for i, name in enumerate(m.name):
        for part, values in (("angle_rad", m.position), ("speed", m.velocity), ("effort", m.effort)):
            if i < len(values):
                yield f"{name}.{part}", "", float(values[i])


MESSAGES: dict[str, tuple[int, Callable[[Any, str], Iterator[Part]]]] = {
    "sensor_msgs/msg/NavSatFix": (0, fix),
    "nav_msgs/msg/Odometry": (0, odometry),
    "sensor_msgs/msg/Imu": (1, imu),
    "geometry_msgs/msg/QuaternionStamped": (0, quaternion),
    "sensor_msgs/msg/JointState": (9, joints),
    "geometry_msgs/msg/PoseStamped": (1, pose),
    "geometry_msgs/msg/PoseWithCovarianceStamped": (1, pose),
    "geometry_msgs/msg/TwistStamped": (1, twist),
    "geometry_msgs/msg/TwistWithCovarianceStamped": (1, twist),
}
"""{type: (rank among types that hold one quantity, what it holds)}; any other gives its plain numbers."""
