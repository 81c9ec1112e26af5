"""`python -m bench.fleet VERB`: run, table, fit, keep, add, together, partly, peer, prior, variation,
proofs, instruments."""

import argparse
import sys

from bench.fleet import (
    addition_proof,
    decision_fit,
    false_proofs,
    fleet_page,
    keep_answers,
    kinematic_errors,
    part_of_a_voyage,
    prior_fit,
    several_voyages,
    sparse_peer,
    variation_fit,
)
from bench.fleet import run as verb_run
from twin.errors import TwinError


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m bench.fleet", description="Random ships of many forms, asked."
    )
    verbs = parser.add_subparsers(dest="verb", required=True)
    each = {
        "run": verb_run,
        "table": fleet_page,
        "fit": decision_fit,
        "keep": keep_answers,
        "add": addition_proof,
        "together": several_voyages,
        "partly": part_of_a_voyage,
        "peer": sparse_peer,
        "prior": prior_fit,
        "variation": variation_fit,
        "proofs": false_proofs,
        "instruments": kinematic_errors,
    }
    for name, module in each.items():
        module.add_arguments(verbs.add_parser(name, description=(module.__doc__ or "").splitlines()[0]))
    args = parser.parse_args()
    try:
        return int(each[args.verb].run(args))
    except TwinError as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(main())
