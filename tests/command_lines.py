"""Command lines that several tests give."""


def init(name, *more):
    """`twin init` of a cargo ship of 180 m, to be given to `twin.cli.main`; `more`: its output, and so on."""
    size = ["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5"]
    return ["init", name, *size, *map(str, more)]
