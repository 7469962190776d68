"""Bundle of the player from its sources: ``python -m tests.viewer.bundle`` makes it and needs npm."""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import nonsmooth

_VIEWER = Path(nonsmooth.__file__).parent / "viewer"
SOURCES = _VIEWER / "player"
BUNDLE, RECORD = _VIEWER / "viewer.js", _VIEWER / "bundle.json"
_ESBUILD = ["--bundle", "--minify", "--format=iife", "--target=es2020", "--legal-comments=eof"]


def sources() -> str:
    """Hash of all files that the bundle is made of."""
    found = hashlib.sha256()
    for path in (*sorted((SOURCES / "src").glob("*.js")), SOURCES / "package.json", SOURCES / "package-lock.json"):
        found.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()


def bundled() -> str:
    """Hash of the bundle."""
    return hashlib.sha256(BUNDLE.read_bytes()).hexdigest()


def build(out: Path) -> None:
    """Write the bundle."""
    subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=SOURCES, check=True)
    esbuild = SOURCES / "node_modules" / "esbuild" / "bin" / "esbuild"
    subprocess.run(["node", esbuild, "src/main.js", *_ESBUILD, f"--outfile={out}"], cwd=SOURCES, check=True)


def main() -> None:
    """Build the bundle, and record its hash, that of its sources, and their versions."""
    build(BUNDLE)
    shutil.copyfile(SOURCES / "node_modules" / "three" / "LICENSE", _VIEWER / "LICENSE-three")
    wanted: dict[str, Any] = json.loads((SOURCES / "package.json").read_text(encoding="utf-8"))
    versions = wanted["dependencies"] | wanted["devDependencies"]
    record = {"versions": versions, "sources": sources(), "bundle": bundled()}
    RECORD.write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
