"""What the routes answer with: JSON, a mistake as its one line, and the files of the page."""

import json
from collections.abc import Awaitable, Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from twin.errors import SettingsError, TwinError, UsageError

MAX_JSON = 256 * 1024  # bytes of a request
KINDS = {
    "html": "text/html",
    "css": "text/css",
    "js": "text/javascript",
    "svg": "image/svg+xml",
    "txt": "text/plain",
}
STATUS = {1: 500, 2: 400, 4: 422, 5: 400}  # exit code -> status
Do = Callable[[Request], Awaitable[Any]]


def answered(do: Do) -> Do:
    """The same as JSON, a mistake as its one line."""

    async def answer(request: Request) -> Response:
        try:
            found = await do(request)
        except TwinError as error:
            return JSONResponse(
                {"said": str(error), "exit_code": error.exit_code}, STATUS.get(error.exit_code, 400)
            )
        except OSError as error:
            said = f"{Path(str(error.filename or '')).name}: {error.strerror}."
            return JSONResponse({"said": said, "exit_code": 1}, 500)
        return found if isinstance(found, Response) else JSONResponse(found)

    return answer


async def body_of(request: Request) -> dict[str, Any]:
    """The object that a request says; UsageError when it is none or too long."""
    data = b""
    async for part in request.stream():
        data += part
        if len(data) > MAX_JSON:
            raise UsageError(f"a request says at most {MAX_JSON} bytes.")
    try:
        said = json.loads(data)
    except (ValueError, RecursionError):
        said = None
    if not isinstance(said, dict):
        raise UsageError("a request says one JSON object.")
    return said


def names_in(said: dict[str, Any], key: str) -> list[str]:
    """A list of names in a request; UsageError when it is something else."""
    names = said.get(key, [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise UsageError(f"{key} must be a list of names.")
    return names


def toml_name(name: Any) -> str:
    text = str(name or "").strip()
    if not text:
        raise SettingsError("a name for the file is needed.")
    return text if text.endswith(".toml") else f"{text}.toml"


def page_files() -> dict[str, tuple[str, bytes]]:
    """{path: (type, bytes)} of the page: all there is, looked up in a table and never on a disk."""
    out = {}
    for file in files("twin.studio.page").iterdir():
        kind = KINDS.get(file.name.rpartition(".")[2])
        if kind and file.is_file():
            path = "/" if file.name == "page.html" else f"/app/{file.name}"
            out[path] = (f"{kind}; charset=utf-8", file.read_bytes())
    number = (files("twin.report") / "number.js").read_text(
        encoding="utf-8"
    ) + "export { asGiven, num, onAxis, readable };\n"
    out["/app/number.js"] = (f"{KINDS['js']}; charset=utf-8", number.encode())  # the same on report pages
    return out
