"""Signal K, AIS and ISO 19848: what each says of a motion is read, and what it cannot say is said."""

import json

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.formats import recognised
from twin.recording.formats.ais import unarmoured
from twin.recording.read import read_voyage

PATHS = {"navigation.headingTrue": "psi", "navigation.rateOfTurn": "rate", "steering.rudderAngle": "rudder"}


def stamp(t):
    return f"2026-11-25T12:{int(t) // 60:02d}:{t % 60:06.3f}Z"


def deltas(m, context="vessels.self"):
    for i, t in enumerate(m["t"]):
        values = [{"path": p, "value": float(np.radians(m[k][i]))} for p, k in PATHS.items()]
        values += [
            {
                "path": "navigation.position",
                "value": {"latitude": m["latitude"][i], "longitude": m["longitude"][i]},
            },
            {"path": "navigation.speedOverGround", "value": 6.0},
            {"path": "navigation.courseOverGroundTrue", "value": float(np.radians(m["psi"][i]))},
            {"path": "propulsion.shaft.revolutions", "value": 1.4},
        ]
        yield {
            "context": context,
            "updates": [{"$source": "can0.52", "timestamp": stamp(t), "values": values}],
        }


def test_a_signal_k_log_goes_in_and_other_vessels_stay_out(tmp_path, sailed):
    path = tmp_path / "deltas.jsonl"
    others = [d | {"context": "vessels.urn:mrn:imo:mmsi:219000001"} for d in deltas(sailed)]
    path.write_text(
        "\n".join(json.dumps(d) for pair in zip(deltas(sailed), others, strict=True) for d in pair)
    )
    assert recognised(path).name == "signalk"
    v = read_voyage(path)
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=1e-6)
    np.testing.assert_allclose(v["propeller_rate_rpm"], 84.0)
    assert any("120 deltas of other vessels" in note for note in v.meta["notes"])


def test_a_whole_number_too_long_for_a_float_costs_its_update_and_no_more(tmp_path, sailed):
    long = '{"updates": [{"timestamp": "%s", "values": [{"path": "navigation.headingTrue", "value": %d}]}]}'
    path = tmp_path / "deltas.jsonl"
    path.write_text("\n".join([*map(json.dumps, deltas(sailed)), long % (stamp(sailed["t"][-1]), 10**400)]))
    signals = recognised(path).series(path)
    assert signals.skipped["updates with a number too long to be one"] == 1
    assert len(signals.series["navigation.headingTrue.can0.52"].values) == len(sailed["t"])


def test_an_iso_19848_package_is_read_by_its_channels(tmp_path, sailed):
    names = ["north_m", "east_m", "heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm"]
    rows = [
        {
            "TimeStamp": stamp(t),
            "Value": [
                str(x)
                for x in (
                    sailed["place"][i].real,
                    sailed["place"][i].imag,
                    sailed["psi"][i],
                    sailed["rudder"][i],
                    84.0,
                )
            ],
        }
        for i, t in enumerate(sailed["t"])
    ]
    package = {
        "Package": {
            "TimeSeriesData": [
                {"TabularData": [{"DataChannelID": [f"/ship/nav/{n}" for n in names], "DataSet": rows}]}
            ]
        }
    }
    rows[0] = rows[0] | {"Value": [*rows[0]["Value"][:4], 10**400]}  # too long to be a number
    path = tmp_path / "package.json"
    path.write_text(json.dumps(package))
    assert recognised(path).name == "iso19848"
    np.testing.assert_allclose(read_voyage(path)["heading_true_north_deg"], sailed["psi"])


def test_ais_says_that_it_holds_no_rudder_and_no_shaft(tmp_path):
    line = "!AIVDM,1,1,,A,13aI8e?P00PGpU:NR6s00?vT2000,0*25"
    body = line[1:].partition("*")[0]
    total = 0
    for c in body.encode():
        total ^= c
    path = tmp_path / "ais.log"
    path.write_text("\n".join(f"{1795608000 + t} !{body}*{total:02X}" for t in range(30)))
    assert recognised(path).name == "ais"
    with pytest.raises(DataError, match="it holds no rudder and no shaft"):
        read_voyage(path)


def test_six_bits_of_each_character_of_an_ais_payload():
    assert unarmoured(b"1w") == (1 << 6) | 63 and unarmoured(b"0W`") == (39 << 6) | 40
