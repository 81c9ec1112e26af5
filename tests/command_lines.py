"""Command lines that several tests give."""

import signal


def hears_interrupts():
    """For `preexec_fn`: SIGINT ends the process, also where whoever runs the tests ignores it (`&`, `nohup`)."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def init(name, *more):
    """`twin init` of a cargo ship of 180 m, to be given to `twin.cli.main`; `more`: its output, and so on."""
    size = ["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5"]
    return ["init", name, *size, *map(str, more)]
