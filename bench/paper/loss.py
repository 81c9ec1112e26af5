"""The losses side by side on the paper's voyages: `python -m bench.paper.loss [--runs 15]` writes
docs/results/loss.md's table.

Each loss trains the same network on the same parts; free runs of 120 s on the test part and on zigzags that
no training saw."""

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from bench.options import positive
from bench.paper.nominal_ship import nominal
from bench.paper.paper_voyages import QUICK, lessons, sail, zigzags
from twin.study.track.track import track

VARIANTS: dict[str, dict[str, Any]] = {
    "paper, lambda_phys 0.1": {"loss": "paper"},
    "paper, lambda_phys 0": {"loss": "paper", "lambda_phys": 0.0},
    "acceleration matching": {"loss": "acceleration"},
    "warm start + 60 s roll-out": {},
    "the same + orthogonality 0.01": {"orthogonality": 0.01},
    "the same + mirror 0.1": {"mirror": 0.1},
}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.paper.loss", description=__doc__)
    parser.add_argument("--runs", type=positive, default=QUICK.runs)
    parser.add_argument("--epochs", type=positive, default=150)
    parser.add_argument("--rollout-epochs", type=positive, default=30)
    parser.add_argument("--work", type=Path, default=Path(".paper"))
    parser.add_argument(
        "--only", metavar="LOSS", nargs="+", choices=VARIANTS, default=list(VARIANTS), help="some of them"
    )
    args = parser.parse_args()
    for line in table(args.runs, args.epochs, args.rollout_epochs, args.work, args.only):
        print(line, flush=True)
    return 0


def table(
    runs: int, epochs: int, rollout_epochs: int, work: Path, only: Sequence[str] = tuple(VARIANTS)
) -> Any:
    """Lines of the table, as they are ready."""
    from export.data import leg, model_of, split
    from export.settings import TrainingSettings
    from export.teach import teach
    from export.worth import share, worth

    ship = nominal()
    cases = lessons(replace(QUICK, runs=runs))
    sailed = sail([*cases, *zigzags(2, 9001)], work, lambda text: print(text, file=sys.stderr))
    tracks = [track(s.voyage, ship) for s in sailed]
    model = model_of(ship, tracks)
    legs = [leg(t, model) for t in tracks]
    parts = split(legs[:runs])
    yield (
        "| loss | zigzag: heading deg | place m | test: heading deg | place m | rms of f | share of force "
        "| epochs | CPU s |"
    )
    yield "|---|---|---|---|---|---|---|---|---|"
    for name in only:
        began = time.process_time()
        taught = teach(
            parts, model, TrainingSettings(epochs=epochs, rollout_epochs=rollout_epochs, **VARIANTS[name])
        )
        spent = time.process_time() - began
        zz, test = worth(taught.network, model, legs[runs:]), worth(taught.network, model, parts["test"])
        if name == only[0]:
            before = [zz.heading_deg[0], zz.position_m[0], test.heading_deg[0], test.position_m[0]]
            yield f"| physics only | {' | '.join(f'{x:.3g}' for x in before)} | | | | |"
        s = taught.samples.situation(slice(None))
        part = share(taught.network, model, s)
        rms = float((taught.network.f(taught.network.zeta(s)).detach() ** 2).mean().sqrt())
        yield (
            f"| {name} | {zz.heading_deg[1]:.3f} | {zz.position_m[1]:.2f} | {test.heading_deg[1]:.3f} | "
            f"{test.position_m[1]:.2f} "
            f"| {rms:.3f} | {100 * part:.1f} % | {len(taught.curve)} | {spent:.0f} |"
        )
        print(name, taught.diagnostics, file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
