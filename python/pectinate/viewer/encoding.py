"""Numbers small enough for a page: whole numbers, differences, bytes of a kind together, deflate.

`static/decode.js` is the other half.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

_STEPS = 65535
_DIRECTION_STEPS = 127
NO_VALUE = 65535
"""What stands for a number that is not finite among quantized values."""


class ArrayPack:
    """Collects arrays of unsigned integers; `base64` is all of them, and what `add` returns tells where each one is."""

    def __init__(self) -> None:
        self._chunks: list[bytes] = []
        self._size = 0

    def add(self, array: NDArray[Any], differences: int = 0) -> dict[str, int]:
        """Store an array.

        Parameters
        ----------
        array : (n,) or (n, c) uint16 or uint32
            What to store.
        differences : int
            How often each row is replaced by its difference to the row before: 1 for what changes little, 2 for what
            changes evenly. They wrap around, so nothing is lost.

        Returns
        -------
        dict
            Its place in the pack, ready for JSON.
        """
        table = array.reshape(len(array), -1)
        for _ in range(differences):
            table = np.diff(table, axis=0, prepend=np.zeros((1, table.shape[1]), table.dtype))
        if differences:
            table = _folded(table)
        # Column by column, low bytes before high bytes: the high ones are nearly all zero.
        planes = np.ascontiguousarray(table.T).astype(table.dtype.newbyteorder("<"), copy=False)
        data = planes.view(np.uint8).reshape(table.shape[1], len(table), -1).transpose(0, 2, 1).tobytes()
        place = {
            "start": self._size,
            "rows": len(table),
            "columns": table.shape[1],
            "bytes": table.dtype.itemsize,
            "differences": differences,
        }
        self._chunks.append(data)
        self._size += len(data)
        return place

    def base64(self) -> str:
        """All arrays, deflated (zlib), as text."""
        return base64.b64encode(zlib.compress(b"".join(self._chunks), 9)).decode("ascii")


def quantized_points(points: NDArray[np.float64]) -> tuple[NDArray[np.uint16], dict[str, Any]]:
    """Points (n, 3) in mm as whole steps from a corner of their box, and how to go back, ready for JSON.

    The step is a 65535th of the longest side of the box, on all axes: about 1.5 micrometres for an atrium.
    """
    if not len(points):
        return np.zeros((0, 3), np.uint16), {"origin": [0.0, 0.0, 0.0], "step": 1.0}
    origin = points.min(axis=0)
    step = float(np.ptp(points, axis=0).max()) / _STEPS or 1.0
    return np.rint((points - origin) / step).astype(np.uint16), {"origin": origin.tolist(), "step": step}


def quantized_values(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.uint16]:
    """Numbers as whole steps of their range, those beyond it at its ends, and `NO_VALUE` for what is not finite."""
    finite = np.isfinite(values)
    # Halves, because the difference of two finite numbers may be infinite.
    share = (0.5 * np.where(finite, values, low) - 0.5 * low) / (0.5 * high - 0.5 * low)
    steps = np.rint(np.clip(share, 0.0, 1.0) * (NO_VALUE - 1)).astype(np.uint16)
    return np.where(finite, steps, np.uint16(NO_VALUE))


def quantized_directions(vectors: NDArray[np.float64]) -> NDArray[np.uint16]:
    """Unit vectors (n, 3) in 127ths; numbers below 0 wrap around."""
    return np.rint(_DIRECTION_STEPS * vectors).astype(np.int16).view(np.uint16)


def coherent_order(
    vertices: NDArray[np.float64], triangles: NDArray[np.integer[Any]]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Order triangles along a curve that fills space, and vertices as these triangles first use them.

    Returns
    -------
    triangle_order : (T,) int64
        Triangles in their new order.
    vertex_order : (W,) int64
        Vertices in their new order, without those that no triangle uses.
    """
    middles = vertices[triangles].mean(axis=1)
    steps, _ = quantized_points(middles)
    triangle_order = np.argsort(_interleaved(steps >> 6), kind="stable")
    used, first = np.unique(triangles[triangle_order], return_index=True)
    return triangle_order, used[np.argsort(first)].astype(np.int64)


def first_use_codes(triangles: NDArray[np.int64]) -> NDArray[np.uint32]:
    """Triangles (T, 3) whose vertices are numbered by first use, as (3 T,): 0 a new vertex, else how far back it is."""
    corners = triangles.ravel()
    is_new = np.zeros(len(corners), dtype=np.int64)
    is_new[np.unique(corners, return_index=True)[1]] = 1
    seen = np.cumsum(is_new) - is_new
    return (seen - corners).astype(np.uint32)


def _folded(table: NDArray[Any]) -> NDArray[Any]:
    """Small numbers of either sign, wrapped around, as small ones: 0, -1, 1, -2, ... become 0, 1, 2, 3, ..."""
    bits = 8 * table.dtype.itemsize
    signs = np.where(table >> table.dtype.type(bits - 1), ~table.dtype.type(0), table.dtype.type(0))
    return np.asarray((table << table.dtype.type(1)) ^ signs)


def _interleaved(steps: NDArray[np.integer[Any]]) -> NDArray[np.int64]:
    """Bits of three numbers below 1024, taken in turn."""
    result = np.zeros(len(steps), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            result |= ((steps[:, axis].astype(np.int64) >> bit) & 1) << (3 * bit + axis)
    return result
