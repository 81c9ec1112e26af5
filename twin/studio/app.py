"""The routes: thin over the project's files, its jobs, and the Python interface.

What the first picture does not need (the study, the reports) is imported when it is first asked for."""

import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from types import ModuleType
from typing import Any

import anyio
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from twin import __version__
from twin.errors import SettingsError, TwinError, UsageError
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
from twin.studio.jobs import SHOWN, Jobs
from twin.studio.live import Live
from twin.studio.project import Project, unchanged
from twin.studio.replies import Do, answered, body_of, names_in, page_files, toml_name
from twin.studio.verbs import checked, files_of
from twin.studio.written_map import write_map

MAX_UPLOAD = 1 << 30  # bytes of a file
TURN_S = 0.2  # between two looks at what waits


class Studio:
    """What the routes share."""

    def __init__(self, folder: str | Path, read_only: bool = False, most_upload: int = MAX_UPLOAD):
        self.project, self.read_only, self.most_upload = Project(folder), read_only, most_upload
        self.jobs, self.live = Jobs(self.project), Live()
        self.page = page_files()

    def app(self) -> Starlette:
        get, put = self._get, self._put
        routes = [
            *(Route(path, self._file) for path in self.page),
            get("/api/project", self.project_report),
            get("/api/form", self.form),
            get("/api/effects", self.effects),
            get("/api/report", self.report),
            get("/api/ships/{name}", self.ship),
            get("/api/turn", self.turn),
            get("/api/difference", self.differ),
            put("/api/ships/try", self.try_ship),
            put("/api/ships", self.save_ship),
            put("/api/remove", self.remove),
            put("/api/demo", self.demo),
            put("/api/tags", self.tag),
            put("/api/files/{name}", self.upload),
            put("/api/maps", self.save_map),
            put("/api/remedy", self.remedy),
            get("/api/jobs", self.jobs_told),
            put("/api/jobs", self.ask),
            get("/api/jobs/{job}", self.job),
            put("/api/jobs/{job}/cancel", self.cancel),
            put("/api/jobs/{job}/forget", self.forget),
            Route("/api/jobs/{job}/{file}", self.job_file),
            Route("/api/files/{name}", self.download),
            put("/api/live", self.attach, always=True),
            put("/acknowledge", self.live.acknowledge, always=True),
            Route("/events", self.live.events),
            Route("/live", self.live.page),
            *(Route(path, self.live.page) for path in self.live.pages if path != "/"),
        ]
        return Starlette(routes=routes, lifespan=self._lifespan)

    @asynccontextmanager
    async def _lifespan(self, app: Starlette) -> AsyncIterator[None]:
        """Starts what waits, as long as the server runs."""

        async def turns() -> None:
            while True:
                with suppress(TwinError, OSError):  # such as a full disk: the next turn tries again
                    await run_in_threadpool(self.jobs.turn)
                await anyio.sleep(TURN_S)

        async with anyio.create_task_group() as group:
            if not self.read_only:
                group.start_soon(turns)
            yield
            self.live.leave()
            group.cancel_scope.cancel()

    def _get(self, path: str, do: Do) -> Route:
        return Route(path, answered(do))

    def _put(self, path: str, do: Do, always: bool = False) -> Route:
        """A route that changes something: refused when the project is open for reading only."""

        async def asked(request: Request) -> Any:
            if self.read_only and not always:
                raise UsageError(
                    "this project is open for reading only. Start twin studio without --read-only."
                )
            return await do(request)

        return Route(path, answered(asked), methods=["POST"])

    @property
    def trials(self) -> ModuleType:
        """What a ship does before it is sailed (trials.py)."""
        from twin.studio import trials

        return trials

    async def _file(self, request: Request) -> Response:
        kind, data = self.page[request.url.path]
        return Response(data, headers={"Content-Type": kind})

    async def project_report(self, request: Request) -> Any:
        """Files and jobs: what every page begins with."""
        files = await run_in_threadpool(self.project.listing)
        jobs = await run_in_threadpool(self.jobs.all_told)
        return {
            "folder": str(self.project.folder),
            "read_only": self.read_only,
            "version": __version__,
            "files": files,
            "jobs": jobs,
            "live": self.live.name,
        }

    async def form(self, request: Request) -> Any:
        return self.trials.form()

    async def effects(self, request: Request) -> Any:
        """Of a ship, what may be wrong with it; without one the catalogue."""
        from twin.report.catalogue import as_json, chosen

        name = request.query_params.get("ship")
        ship = load(self.project.existing(name)) if name else None
        return as_json(chosen(None, ship), ship)["effects"]

    async def report(self, request: Request) -> Any:
        """The project as it stands, as one page."""
        from twin.studio.project_report import page

        headers = {"Content-Disposition": 'attachment; filename="project.html"'}
        return Response(await run_in_threadpool(page, self.project), media_type="text/html", headers=headers)

    async def ship(self, request: Request) -> Any:
        path = self.project.existing(request.path_params["name"])
        return await run_in_threadpool(lambda: self.trials.shown(load(path)))

    async def turn(self, request: Request) -> Any:
        ship, voyage = (self.project.existing(request.query_params.get(k, "")) for k in ("ship", "voyage"))
        return await run_in_threadpool(lambda: self.trials.measured_turn(str(voyage), load(ship)))

    async def differ(self, request: Request) -> Any:
        from twin.studio.answers import difference

        files = [self.project.existing(request.query_params.get(k, "")) for k in ("before", "after")]
        lines = await run_in_threadpool(difference, *map(str, files))
        return {"lines": [line.replace(f"{self.project.folder}/", "") for line in lines]}

    async def try_ship(self, request: Request) -> Any:
        said = await body_of(request)
        ship, warnings = await run_in_threadpool(
            self.trials.made, str(said.get("name") or "ship"), said.get("values")
        )
        told = await run_in_threadpool(self.trials.shown, ship)
        command = self.trials.command(ship.name, said["values"], str(said.get("output") or "SHIP.toml"))
        return told | {"warnings": warnings, "command": command}

    async def save_ship(self, request: Request) -> Any:
        said = await body_of(request)
        output = self.project.new(toml_name(said.get("output")))
        made = await run_in_threadpool(self.trials.made, str(said.get("name") or ""), said.get("values"))
        made[0].save(output)
        return {"output": output.name}

    async def remove(self, request: Request) -> Any:
        from twin.study.update.removal import remove

        said = await body_of(request)
        output = self.project.new(toml_name(said.get("output")))
        like = self.project.existing(str(said.get("ship")))
        save(remove(load(like), names_in(said, "effects")), output, like)
        return {"output": output.name}

    async def demo(self, request: Request) -> Any:
        return {"taken": self.project.take_demo()}

    async def tag(self, request: Request) -> Any:
        said = await body_of(request)
        self.project.tag(str(said.get("file")), str(said.get("tag")))
        return {}

    async def upload(self, request: Request) -> Any:
        """A file into the folder: whole or not at all, never over another, no longer than it may be."""
        path, size = self.project.new(request.path_params["name"]), 0
        with tempfile.NamedTemporaryFile(dir=self.project.folder, prefix=".upload-", delete=False) as aside:
            try:
                async for part in request.stream():
                    size += len(part)
                    if size > self.most_upload:
                        raise UsageError(
                            f"{path.name}: is longer than {self.most_upload} bytes. Cut it in parts."
                        )
                    aside.write(part)
                aside.flush()
                Path(aside.name).chmod(0o644)
                self.project.new(path.name)
                Path(aside.name).replace(path)
            except (TwinError, OSError, ClientDisconnect):
                Path(aside.name).unlink(missing_ok=True)
                raise
        return {"name": path.name, "bytes": size}

    async def save_map(self, request: Request) -> Any:
        """A map as it was typed, when it is a valid one; it may be written over: it is worked on here."""
        said = await body_of(request)
        name = toml_name(said.get("name"))
        path = self.project.path(name)
        if path.exists() and not any(
            f["name"] == name and f["kind"] == "map" for f in self.project.listing()
        ):
            raise SettingsError(f"{name}: is there already and is no map. Choose another name.")
        unchanged(path, said.get("base"))
        write_map(path, str(said.get("text", "")))
        return {"name": name}

    async def remedy(self, request: Request) -> Any:
        """Writes what a check asks for into the map."""
        from twin.studio.remedies import edited

        said = await body_of(request)
        name, text, edit = toml_name(said.get("name")), str(said.get("text", "")), said.get("edit")
        if not isinstance(edit, dict):
            raise UsageError("a remedy says which entries of the map it changes.")
        unchanged(self.project.path(name), text)
        try:
            write_map(self.project.path(name), edited(text, edit))
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise SettingsError(
                f"{name}: this remedy does not fit the map: {error}. Edit the map itself."
            ) from None
        return {"name": name}

    async def jobs_told(self, request: Request) -> Any:
        return await run_in_threadpool(self.jobs.all_told)

    async def ask(self, request: Request) -> Any:
        asked = checked(await body_of(request))
        for name in files_of(asked):
            self.project.existing(name)
        if "output" in asked:
            self.project.new(asked["output"])
        return {"job": await run_in_threadpool(self.jobs.add, asked)}

    async def job(self, request: Request) -> Any:
        return await run_in_threadpool(self.jobs.report, request.path_params["job"])

    async def cancel(self, request: Request) -> Any:
        await run_in_threadpool(self.jobs.cancel, request.path_params["job"])
        return {}

    async def forget(self, request: Request) -> Any:
        await run_in_threadpool(self.jobs.forget, request.path_params["job"])
        return {}

    async def job_file(self, request: Request) -> Response:
        """A file of a job, as it is on the disk."""
        with suppress(TwinError):
            path = self.jobs.at(request.path_params["job"]) / request.path_params["file"]
            if path.name in SHOWN and path.is_file():
                kind = {".json": "application/json", ".html": "text/html"}.get(
                    path.suffix, "application/octet-stream"
                )
                headers = {"Content-Disposition": f'attachment; filename="{path.parent.name}.html"'}
                return FileResponse(
                    path, media_type=kind, headers=headers if path.suffix == ".html" else None
                )
        return JSONResponse({"said": "there is no such file (yet)."}, 404)

    async def download(self, request: Request) -> Response:
        try:
            path = self.project.existing(request.path_params["name"])
        except TwinError as error:
            return JSONResponse({"said": str(error)}, 404)
        return FileResponse(path, media_type="application/octet-stream", filename=path.name)

    async def attach(self, request: Request) -> Any:
        said = await body_of(request)
        if said.get("leave"):
            self.live.leave()
            return {}
        log = str(self.project.existing(str(said["log"]))) if said.get("log") else None
        place = said.get("connect")
        return {"name": await run_in_threadpool(self.live.attach, str(place) if place else None, log)}
