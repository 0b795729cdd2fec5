"""Arrays in a numpy archive of others: neither pickles nor more than the file may expand to."""

import io
import tokenize
import zipfile
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["ArrayHeader", "array_from", "array_header", "array_members", "load_arrays"]


@dataclass(frozen=True)
class ArrayHeader:
    """What the head of an .npy file says.

    Attributes:
        shape: of the array.
        is_fortran: whether its first index runs fastest.
        dtype: of its elements.
        start: where they begin in the file.
    """

    shape: tuple[int, ...]
    is_fortran: bool
    dtype: np.dtype[Any]
    start: int


def load_arrays(data: bytes, *, largest: int) -> dict[str, NDArray[np.generic]]:
    """The arrays of an .npz archive by name.

    Args:
        data: the archive.
        largest: bytes that they may take together.

    Raises:
        ValueError: it is none, is damaged, or would take more.
    """
    return {name: _array(member) for name, member in array_members(data, largest=largest).items()}


def array_members(data: bytes, *, largest: int) -> dict[str, bytes]:
    """The .npy files in an .npz archive by name, without their ending.

    Args:
        data: the archive.
        largest: bytes that they may take together.

    Raises:
        ValueError: it is none, is damaged, or would take more.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if sum(member.file_size for member in members) > largest:
                raise ValueError("the arrays are too large")
            return {member.filename.removesuffix(".npy"): archive.read(member) for member in members}
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, OSError, RuntimeError, KeyError):
        raise ValueError("not an archive of arrays") from None


def array_header(data: bytes) -> ArrayHeader:
    """What the head of an .npy file says of its array.

    Raises:
        ValueError: it is damaged.
    """
    file = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(file)
        is_old = version == (1, 0)
        read = np.lib.format.read_array_header_1_0 if is_old else np.lib.format.read_array_header_2_0
        shape, fortran, dtype = read(file)
    except (ValueError, TypeError, SyntaxError, OverflowError, RecursionError, MemoryError):
        raise ValueError("not an array: its head is damaged") from None
    except tokenize.TokenError:  # what numpy looks for where a head is of Python 2
        raise ValueError("not an array: its head is damaged") from None
    return ArrayHeader(shape, fortran, dtype, file.tell())


def array_from(data: bytes, header: ArrayHeader) -> NDArray[np.generic]:
    """The array of an .npy file that holds numbers or text.

    Raises:
        ValueError: it is not as large as its head says, or holds objects.
    """
    shape, dtype = header.shape, header.dtype
    # Numpy would make room for what the header says before it looks for it.
    count = int(np.prod(np.array(shape, dtype=object))) if shape else 1
    if (
        dtype.hasobject
        or any(side < 0 for side in shape)
        or count * dtype.itemsize != len(data) - header.start
    ):
        raise ValueError("an array is not as large as it says")
    array = np.frombuffer(data, dtype, count, header.start)
    return array.reshape(shape, order="F" if header.is_fortran else "C").copy()


def _array(data: bytes) -> NDArray[np.generic]:
    return array_from(data, array_header(data))
