"""The software bill of materials (CycloneDX 1.5) of what requirements.lock installs: names, versions, hashes
of every file.

    python deploy/sbom.py requirements.lock sbom.json      the same lock gives the same bytes
"""

import json
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s\\;]+)")
HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})")
VIA = re.compile(r"^\s+#\s+(?:via\s+)?([A-Za-z0-9._-]+)(?:\s+\(.*\))?\s*$")
PYPROJECT = Path(__file__).resolve().parents[1] / "pyproject.toml"


def locked(text: str) -> list[dict[str, Any]]:
    """[{name, version, hashes, via}] of a lock file with hashes; via: who needs it."""
    found: list[dict[str, Any]] = []
    for line in text.splitlines():
        if pin := PIN.match(line):
            found.append({"name": pin[1].lower(), "version": pin[2], "hashes": [], "via": []})
        if found:
            found[-1]["hashes"] += HASH.findall(line)
            if via := VIA.match(line):
                found[-1]["via"].append(via[1].lower())
    return found


def bill(text: str, release: dict[str, str]) -> dict[str, Any]:
    """The bill of a lock file's text; `release`: name and version of the twin itself."""
    parts = locked(text)
    own = f"pkg:pypi/{release['name']}@{release['version']}"
    refs = {part["name"]: purl(part) for part in parts} | {release["name"]: own}
    needs: dict[str, list[str]] = {ref: [] for ref in refs.values()}
    for part in parts:
        for user in part["via"]:
            if user in refs:
                needs[refs[user]].append(refs[part["name"]])
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "bom-ref": own, **release, "purl": own}},
        "components": [component(part) for part in parts],
        "dependencies": [{"ref": ref, "dependsOn": sorted(on)} for ref, on in sorted(needs.items())],
    }


def component(part: dict[str, Any]) -> dict[str, Any]:
    hashes = [{"alg": "SHA-256", "content": digest} for digest in sorted(part["hashes"])]
    return {
        "type": "library",
        "bom-ref": purl(part),
        "name": part["name"],
        "version": part["version"],
        "purl": purl(part),
        "hashes": hashes,
    }


def purl(part: dict[str, Any]) -> str:
    return f"pkg:pypi/{part['name']}@{part['version']}"


def main(lock: str, output: str) -> int:
    project = tomllib.loads(PYPROJECT.read_text())["project"]
    made = bill(Path(lock).read_text(), {"name": project["name"], "version": project["version"]})
    Path(output).write_text(json.dumps(made, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]) if len(sys.argv) == 3 else __doc__)
