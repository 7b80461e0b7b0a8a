"""The pages that are made, and what makes each."""

from __future__ import annotations

from tests.manual.commands import commands_page
from tests.manual.keys import DOCS, job_page, scene_page

PAGES = {
    DOCS / "job_keys.md": job_page,
    DOCS / "scene_keys.md": scene_page,
    DOCS / "commands.md": commands_page,
}
