"""The column of a voyage in which each input of an effect is recorded."""

INPUTS = {
    "wind_speed": "true_wind_speed_mps",
    "wind_to": "true_wind_direction_deg",
    "depth": "water_depth_m",
    "H_s": "wave_height_significant_m",
    "T_p": "wave_period_peak_s",
    "wave_to": "wave_direction_deg",
    "bank_port": "bank_distance_port_m",
    "bank_starboard": "bank_distance_starboard_m",
    "phi": "roll_deg",
    "u_r": "surge_velocity_through_water_mps",
    "v_r": "sway_velocity_through_water_mps",
    "t": "time_s",
    "r": "yaw_rate_degps",
}
