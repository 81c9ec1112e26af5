"""What the paper claims, what this run found, and whether that is enough: made by the command, so that no row
is older than its run."""

from collections.abc import Iterator
from statistics import mean, stdev
from typing import Any, NamedTuple

TENTH = 0.1  # of all runs that teach: from so few the hybrid shall be as good as the LSTM from all
GOALS_7 = {"Mass error M (+5%)": 1.2, "Damping error D (+10%)": 2.5, "GNSS sensor noise (0.5 m)": 0.8}


class Claim(NamedTuple):
    """One line: what is asked, what was found, and whether it is met."""

    asked: str
    here: str
    met: bool


def lines(r: dict[str, Any]) -> list[str]:
    """The table."""
    return [
        "",
        "## What was claimed, and what this run found",
        "",
        "| the paper's claim, as this project asks for it | here | met |",
        "|---|---|---|",
        *(f"| {c.asked} | {c.here} | {'yes' if c.met else '**no**'} |" for c in claims(r)),
    ]


def claims(r: dict[str, Any]) -> Iterator[Claim]:
    """All of them, in the order of the tables."""
    yield _times(r, "analytic", "the nominal analytic model", 14.0, 12.7)
    yield _times(r, "ekf", "the EKF", 3.2, 3.1)
    yield _r2(r["tables"]["3"])
    if len(r["tables"]["3"]["by_seed"]["hybrid"]) > 1:
        yield _seeds(r["tables"]["3"]["by_seed"]["hybrid"])
        yield _named(r)
    yield _gap(r["models"]["gap"]["hybrid"])
    yield _seven(r["tables"]["7"], "lateral")
    yield _seven(r["tables"]["7"], "heading")
    yield from tenth_claim(r)
    yield _closed([x for x in r["tables"]["fig5"] if x["mode"] == "with the residual"])


def _times(r: dict[str, Any], name: str, words: str, heading: float, lateral: float) -> Claim:
    a, b = r["ratios"][f"heading_vs_{name}"], r["ratios"][f"lateral_vs_{name}"]
    return Claim(
        f"{heading:g} x in heading and {lateral:g} x lateral against {words}",
        f"{a:.1f} x, {b:.1f} x",
        a >= heading and b >= lateral,
    )


def _r2(t: dict[str, Any]) -> Claim:
    a, b = t["r2_heading"]["hybrid"], t["r2_lateral"]["hybrid"]
    return Claim("R2 at least 0.96", f"{a:.3f}, {b:.3f}", min(a, b) >= 0.96)


def _seeds(rows: list[list[float]]) -> Claim:
    a, b = (100.0 * stdev(x) / mean(x) for x in zip(*rows, strict=True))
    return Claim(f"{len(rows)} seeds within 3.2 %", f"heading {a:.1f} %, lateral {b:.1f} %", max(a, b) <= 3.2)


def _named(r: dict[str, Any]) -> Claim:
    seeds, models = r["tables"]["3"]["by_seed"], r["models"]
    (a, x), (b, y) = (
        tuple(mean(v) for v in zip(*seeds[n], strict=True)) for n in ("physics_added_hybrid", "hybrid")
    )
    less, more = (100.0 * models[n]["share_of_force"] for n in ("physics_added_hybrid", "hybrid"))
    wins = sum(
        one[0] < other[0] for one, other in zip(seeds["physics_added_hybrid"], seeds["hybrid"], strict=True)
    )
    better = (
        f"{a:.3f} against {b:.3f} deg (in {wins} of {len(seeds['hybrid'])} seeds), {x:.2f} against {y:.2f} m"
    )
    here = f"{better}; {more:.1f} to {less:.1f} % of the force"
    return Claim(
        "physics named plus network beats the network alone, and the network's share falls",
        here,
        a < b and x <= y and less < more,
    )


def _gap(found: dict[str, Any]) -> Claim:
    told = []
    for name in ("heading", "lateral"):
        low, high = found[name]["by_voyage_95"]
        told.append(
            f"{name} {found[name]['change_percent']:+.1f} % (95 % by voyage {low:+.0f} to {high:+.0f} %)"
        )
    met = all(found[name]["change_percent"] <= 4.5 for name in ("heading", "lateral"))
    return Claim("validation to test within 4.5 % (more runs: [gap.md](gap.md))", ", ".join(told), met)


def _seven(t: dict[str, Any], measure: str) -> Claim:
    found = {case: t[case][f"{measure}_change_percent_of_analytic"]["hybrid_adapted"] for case in GOALS_7}
    asked = " / ".join(f"+{goal:g}" for goal in GOALS_7.values())
    here = " / ".join(f"{x:+.1f}" for x in found.values()) + " %"
    if missed := [case.split()[0].lower() for case, goal in GOALS_7.items() if found[case] > goal]:
        here += f" ({', '.join(missed)} not)"
    return Claim(
        f"Table 7, learning on, {measure}: mass / damping / GNSS within {asked} % of the nominal "
        "analytic error",
        here,
        not missed,
    )


def tenth_claim(r: dict[str, Any]) -> Iterator[Claim]:
    three = r["tables"]["3"]
    goal = three["heading_mae_deg"]["lstm"], three["lateral_mae_m"]["lstm"]
    few = [x for x in r["tables"]["data"] if x["runs"] <= TENTH * r["models"]["parts"]["train"]]
    if few:
        most = max(few, key=lambda x: x["runs"])
        a, b = (mean(x) for x in zip(*most["by_seed"], strict=True))
        alone = most["hybrid"]
        yield Claim(
            f"the LSTM's accuracy with all data ({goal[0]:.3f} deg, {goal[1]:.2f} m), by the hybrid from a "
            "tenth of it",
            f"from {most['runs']} of {r['models']['parts']['train']} runs, named: {a:.3f} deg, {b:.2f} m; "
            "the network alone "
            f"{alone['heading_mae_deg']:.3f}, {alone['lateral_mae_m']:.2f}",
            a <= goal[0] and b <= goal[1],
        )


def _closed(rows: list[dict[str, Any]]) -> Claim:
    worst = {
        n: max(x[n] for x in rows)
        for n in ("settle_lengths_max", "overshoot_percent", "steady_error_max", "rudder_deg")
    }
    here = (
        f"{worst['settle_lengths_max']:.1f} L/U, {worst['overshoot_percent']:.1f} %, "
        f"{worst['steady_error_max']:.3f}, "
        f"{worst['rudder_deg']:.1f} deg, worst of {sum(x['runs'] for x in rows)} runs"
    )
    return Claim(
        "Fig. 5, with the residual: 5 L/U, 8 %, 0.02, rudder short of its stop",
        here,
        all(x["met"] for x in rows),
    )
