"""The table of claims: what a run of the whole plan says that a small one never reaches."""

from bench.paper.claims import tenth_claim


def test_the_claim_of_a_tenth_takes_the_largest_run_that_is_one_and_tells_how_many_taught():
    rows = [
        {
            "runs": n,
            "by_seed": [[h, 1.1], [h + 0.02, 1.3]],
            "hybrid": {"heading_mae_deg": 0.3, "lateral_mae_m": 1.5},
        }
        for n, h in ((1, 0.9), (4, 0.16), (43, 0.1))
    ]
    tables = {"3": {"heading_mae_deg": {"lstm": 0.2}, "lateral_mae_m": {"lstm": 1.33}}, "data": rows}
    (claim,) = tenth_claim({"tables": tables, "models": {"parts": {"train": 43}}})
    assert claim.met and claim.here.startswith(
        "from 4 of 43 runs, named: 0.170 deg, 1.20 m; the network alone 0.300, 1.50"
    )
    tables["3"]["heading_mae_deg"]["lstm"] = 0.15
    assert not next(tenth_claim({"tables": tables, "models": {"parts": {"train": 43}}})).met
    assert not list(tenth_claim({"tables": tables, "models": {"parts": {"train": 9}}}))
