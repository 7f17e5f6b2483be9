"""Numbers from callers as float64 arrays, or an error that says what they were instead."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def numbers(what: str, values: Any) -> npt.NDArray[np.float64]:
    """Give ``values`` as a C-contiguous float64 array of whatever shape they have.

    Raises:
        ValueError: naming ``what``, unless they are real numbers: text, flags and complex numbers
            are not.
    """
    try:
        array = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{what} must be numbers: {error}") from error
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{what} must be numbers, not {array.dtype}")
    # A number too large for float64 becomes infinite, which is then refused as such.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype=np.float64)
