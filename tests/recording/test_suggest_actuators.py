"""What a proposed map has of the columns of several actuators."""

from twin.recording.columns_seen import columns_seen
from twin.recording.suggest_actuators import actuator_columns, why_of


def seen_in(tmp_path, header, row):
    path = tmp_path / "vdr.csv"
    path.write_text("\n".join([header, *[row] * 30]) + "\n")
    return [columns_seen(path)]


def test_a_single_letter_is_a_side_where_the_other_side_stands_beside_it(tmp_path):
    """Test: an export of a bridge with RPM_P beside RPM_S, and one with a column of P and no other. Expected: both
    sides of a ship; no side at all, for P may be anything."""
    found = actuator_columns(
        seen_in(tmp_path, "RPM_P,RPM_S,PITCH_P,PITCH_S,RUD_P,RUD_S,BOWTHR", "145,144,60,61,-5,-4,20")
    )
    whose = {channel: name for channel, ((_, name), _) in found.items()}
    assert whose["port.rate_rpm"] == "RPM_P" and whose["starboard.rate_rpm"] == "RPM_S"
    assert whose["port.pitch_ratio"] == "PITCH_P" and whose["starboard.angle_deg"] == "RUD_S"
    assert [c for c in whose if c.startswith("bow.")]
    assert not actuator_columns(seen_in(tmp_path, "RPM_P,HDG", "145,40"))


def test_a_pitch_in_per_cent_asks_for_the_pitch_at_full(tmp_path):
    found = actuator_columns(seen_in(tmp_path, "RPM_P,RPM_S,PITCH_P,PITCH_S", "145,144,60,1.1"))
    said = {c: why_of(how, where[0].numbers(where[1])) for c, (where, how) in found.items() if "pitch" in c}
    assert any("pitch over diameter at full pitch" in why for why in said["port.pitch_ratio"])
    assert len(said["starboard.pitch_ratio"]) == 1
