"""What is measured of how a ship moves, and the channel that each reading comes from."""

MEASURED = {  # reading -> channel
    "x": "north_m",
    "y": "east_m",
    "psi": "heading_true_north_deg",
    "u": "surge_velocity_mps",
    "v": "sway_velocity_mps",
    "r": "yaw_rate_degps",
    "u_r": "surge_velocity_through_water_mps",
    "v_r": "sway_velocity_through_water_mps",
}
READINGS = tuple(MEASURED)
