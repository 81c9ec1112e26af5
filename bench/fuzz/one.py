"""One target in the fuzzer's own process (libFuzzer by way of atheris), which never returns:

python -m bench.fuzz.one TARGET [libFuzzer's options] CORPUS
"""

import sys

# sums and products without a branch that an input could reach: watched, they take forty times as long
ALGEBRA = ("twin.physics.maths", "twin.live.certificate.comparison_systems")


def main() -> None:
    import atheris

    # what the target imports is instrumented while it is imported: so not before
    with atheris.instrument_imports(["twin", "tomllib"], exclude=[*ALGEBRA], enable_loader_override=False):
        from bench.fuzz.targets import TARGETS

        target = TARGETS[sys.argv[1]].make()
        # parts that are loaded on first use must be instrumented as well
        for seed in TARGETS[sys.argv[1]].seeds():
            target.one(seed)
    atheris.Setup([sys.argv[0], *sys.argv[2:]], target.one)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
