"""Make the player's bundle anew: ``python -m nonsmooth.viewer.player.update``; needs npm, for its authors only."""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
BUNDLE = HERE.parent / "viewer.js"
TOLD = HERE.parent / "bundle.json"
_ESBUILD = ["--bundle", "--minify", "--format=iife", "--target=es2020", "--legal-comments=eof"]


def sources() -> str:
    """Return a hash of all that the bundle is made of."""
    found = hashlib.sha256()
    for path in (*sorted((HERE / "src").glob("*.js")), HERE / "package.json", HERE / "package-lock.json"):
        found.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()


def bundled() -> str:
    """Return a hash of the bundle."""
    return hashlib.sha256(BUNDLE.read_bytes()).hexdigest()


def build(out: Path) -> None:
    """Write the bundle."""
    subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=HERE, check=True)
    esbuild = HERE / "node_modules" / "esbuild" / "bin" / "esbuild"
    subprocess.run(["node", esbuild, "src/main.js", *_ESBUILD, f"--outfile={out}"], cwd=HERE, check=True)


def main() -> None:
    """Build it and write down of what."""
    build(BUNDLE)
    shutil.copyfile(HERE / "node_modules" / "three" / "LICENSE", HERE.parent / "LICENSE-three")
    wanted: dict[str, Any] = json.loads((HERE / "package.json").read_text(encoding="utf-8"))
    versions = wanted["dependencies"] | wanted["devDependencies"]
    told = {"versions": versions, "sources": sources(), "bundle": bundled()}
    TOLD.write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
