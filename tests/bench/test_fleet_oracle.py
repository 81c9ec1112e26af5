"""What the truth is worth on a voyage of the fleet, known to the twin's own form of it."""

from types import SimpleNamespace

import pytest

from bench.fleet.fact_rows import oracle

KINDS = {"Wind": (), "Current": (), "VaryingCurrent": ("Current",), "TowForce": (), "RudderWear": ()}
WEATHER = ("Wind", "Current", "VaryingCurrent")


def answered(errors, likeliest):
    """An answer whose hypotheses lead so far from where the ship went [m]."""
    found = {s: SimpleNamespace(open_loop_error_m=e) for s, e in errors.items()}
    case = SimpleNamespace(
        weather=WEATHER,
        effects=[],
        catalogue={n: SimpleNamespace(holds=h) for n, h in KINDS.items()},
        causes=lambda names: tuple(n for n in names if n not in WEATHER),
        ordered=lambda names: tuple(n for n in KINDS if n in names),
    )
    return SimpleNamespace(case=case, found=found, result={"facts": {"likeliest": likeliest}})


def hidden(*names):
    return SimpleNamespace(hidden=dict.fromkeys(names, 1.0))


def test_hidden_weather_is_worth_nothing_where_other_weather_brings_the_ship_as_near():
    said = answered({(): 40.0, ("Current",): 14.0, ("Wind", "Current"): 13.5}, ("Current",))
    told = oracle(said, hidden("Wind"))
    assert told["without_m"] == pytest.approx(14.0)
    assert told["with_m"] == pytest.approx(13.5)


def test_a_stream_that_varies_holds_the_steady_one_and_neither_counts_without_it():
    errors = {(): 40.0, ("Wind",): 38.0, ("Current",): 14.0, ("VaryingCurrent",): 9.0}
    assert oracle(answered(errors, ("VaryingCurrent",)), hidden("VaryingCurrent"))["without_m"] == 38.0
    steady = {(): 40.0, ("VaryingCurrent",): 9.0, ("Current",): 10.0}
    assert oracle(answered(steady, ("VaryingCurrent",)), hidden("Current"))["without_m"] == 40.0


def test_a_hidden_cause_is_held_against_the_best_weather_alone():
    errors = {(): 40.0, ("Current",): 14.0, ("TowForce",): 30.0, ("Current", "TowForce"): 5.0}
    told = oracle(answered(errors, ("Current", "TowForce")), hidden("TowForce"))
    assert (told["without_m"], told["with_m"]) == (14.0, 5.0)


def test_of_two_hidden_causes_each_is_worth_what_it_gains_beside_the_other():
    errors = {(): 40.0, ("TowForce",): 10.0, ("RudderWear",): 39.0, ("TowForce", "RudderWear"): 9.5}
    told = oracle(answered(errors, ()), hidden("TowForce", "RudderWear"))
    assert told["gain_by_each"] == pytest.approx({"TowForce": 1 - 9.5 / 39, "RudderWear": 0.05})


def test_a_cause_beside_hidden_weather_is_worth_what_it_gains_beside_it():
    errors = {(): 40.0, ("Wind",): 20.0, ("TowForce",): 30.0, ("Wind", "TowForce"): 10.0}
    told = oracle(answered(errors, ()), hidden("Wind", "TowForce"))
    assert told["gain_by_each"] == pytest.approx({"TowForce": 0.5})


def test_a_cause_alone_has_its_oracle_and_nothing_beside_it():
    errors = {(): 40.0, ("TowForce",): 5.0}
    assert oracle(answered(errors, ()), hidden("TowForce"))["gain_by_each"] == {}


def test_what_the_twin_has_no_form_of_has_no_oracle():
    assert oracle(answered({(): 1.0}, ()), hidden("Ice")) is None
