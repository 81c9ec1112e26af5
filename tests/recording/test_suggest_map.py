"""What a proposed map takes from the checks, and what it says of a column that needs a number of the owner's."""

from twin.recording.suggest_entries import Entry
from twin.recording.suggest_map import proved, under_keel


def test_a_sign_that_a_check_proves_is_written_in():
    said = (
        "# rudder_sign: the rudder turns it to the other side: if the rudder is positive to port all of it "
        "agrees; that is believed. In the map: sign = -1 for rudder_angle_deg.\n[columns]\n"
    )
    columns = {"rudder_angle_deg": Entry({"column": "Rudder (+ port)"}, ["unit by its name"])}
    assert proved(columns, {}, said)
    assert columns["rudder_angle_deg"].keys["sign"] == -1
    assert columns["rudder_angle_deg"].why[-1].endswith("CONFIRM")


def test_depth_below_the_keel_is_proposed_with_the_draught_to_be_added():
    line = under_keel(["Remarks", "Water under keel [m]"]).strip()
    assert line.startswith('# water_depth_m = { column = "Water under keel [m]", offset = ')
    assert under_keel(["Remarks", "Keel laid"]) == ""
