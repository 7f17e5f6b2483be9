"""Fresh interpreters for tests: bytecode is kept for the session, wherever the packages lie."""

from __future__ import annotations

import atexit
import os
import shutil
import subprocess
import sys
import tempfile

CACHE = tempfile.mkdtemp(prefix="auvgym-pycache-")
atexit.register(shutil.rmtree, CACHE, ignore_errors=True)


def environment(**more: str) -> dict[str, str]:
    kept = {name: os.environ[name] for name in os.environ if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PYTHONPYCACHEPREFIX": CACHE, **more}


def command(code: str) -> list[str]:
    """The command that runs ``code`` with warnings as errors."""
    return [sys.executable, "-W", "error", "-c", code]


def run(code: str, timeout: float = 60.0, **more: str) -> subprocess.CompletedProcess[str]:
    """Run ``code`` to its end; ``more`` are environment variables."""
    return subprocess.run(
        command(code),
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
        env=environment(**more),
        cwd=tempfile.gettempdir(),
    )
