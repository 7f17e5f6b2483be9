"""Libraries that only some users need are imported when they are first used, through here."""

from __future__ import annotations

import importlib
from typing import Any


def require(module: str, extra: str) -> Any:
    """Import ``module`` (dotted name) and return it.

    ``extra`` is the extra of the auvgym package that brings the library along.
    Raises ImportError that says what to install.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        library = module.partition(".")[0]
        raise ImportError(
            f"this needs {library}, which is not installed or not loadable ({error}); "
            f'install it with: pip install "auvgym[{extra}]"'
        ) from error
