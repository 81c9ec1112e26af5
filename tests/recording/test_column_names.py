"""What a column is, by the words of its name."""

from twin.recording.formats.guess import guess


def test_a_rate_is_in_no_knots_and_a_speed_in_no_turns():
    assert guess("Propeller speed (rpm)").channel == "propeller_rate_rpm"
    assert guess("app_wind_mps").channel == "apparent_wind_speed_mps" and guess("wind_s") is None
    assert guess("wind (deg)").channel == "true_wind_direction_deg"
    assert guess("Speed (kn)").channel == "speed_over_ground_mps" and guess("rate of turn (kn)") is None


def test_a_wind_is_read_by_the_words_of_an_anemometer_and_of_where_it_comes_from():
    names = ("Anemo rel spd kn", "Anemo rel dir", "wind_true_speed", "wind_true_from", "wind_from")
    assert [guess(name).channel for name in names] == [
        "apparent_wind_speed_mps",
        "apparent_wind_angle_deg",
        "true_wind_speed_mps",
        "true_wind_direction_deg",
        "true_wind_direction_deg",
    ]
