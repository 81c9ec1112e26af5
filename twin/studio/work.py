"""`python -m twin.studio.work JOB`: does one job of a project, in a process of its own."""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from twin import whole
from twin.errors import ThresholdError, TwinError
from twin.recording.progress import Progress
from twin.studio.jobs import END, JOB, PROGRESS


def main(folder: Path) -> int:
    """The exit code that the command line would give; `end.json` holds it too."""
    asked = json.loads((folder / JOB).read_text(encoding="utf-8"))["asked"]
    began_s = time.monotonic()

    def tell(text: str) -> None:
        line = json.dumps({"s": round(time.monotonic() - began_s, 2), "text": text})
        with open(folder / PROGRESS, "a", encoding="utf-8") as file:
            file.write(line + "\n")

    code, said = _guarded(lambda: _done(asked, folder, tell))
    if not (folder / END).exists():  # it may have been cancelled meanwhile
        end = {"exit_code": code, "said": said, "ended_s": round(time.time(), 3)}
        whole.write(folder / END, json.dumps(end) + "\n")
    return code


def _done(asked: dict[str, Any], folder: Path, tell: Progress) -> str | None:
    """Does it; the sentence of a threshold that is not met, if there is one."""
    from twin.studio import answers

    return answers.DO[asked["verb"]](asked, folder, tell)


def _guarded(action: Callable[[], str | None]) -> tuple[int, str | None]:
    try:
        said = action()
        return (ThresholdError.exit_code if said else 0), said
    except TwinError as error:
        return error.exit_code, str(error)
    except OSError as error:
        return 4, f"{error.filename or ''}: {error.strerror}. Check the file."
    except MemoryError:
        return 1, "there is not enough memory for this. Give it a shorter voyage."
    except ModuleNotFoundError as error:
        return 1, f"the package {error.name} is needed. Run: pip install 'shiptwin[studio]'"
    except Exception as error:  # the page says it in one line; the whole of it stands in log.txt
        import traceback

        traceback.print_exc()
        return 1, f"{type(error).__name__}: {error}. What happened stands in log.txt of this job."


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
