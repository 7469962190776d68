"""Hook of MkDocs: the site links to the repository that pyproject.toml names, if it names one."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any


def on_config(config: Any) -> Any:
    """Take the address of the repository from the table ``project.urls``, which the wheel shows as well."""
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text("utf-8"))["project"]
    config.repo_url = project["urls"].get("Repository")
    return config
