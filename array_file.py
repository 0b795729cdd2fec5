"""Arrays in a numpy archive of others: neither pickles nor more than the file may expand to."""

import io
import zipfile
import zlib

import numpy as np
from numpy.typing import NDArray

__all__ = ["load_arrays"]


def load_arrays(data: bytes, *, largest: int) -> dict[str, NDArray[np.generic]]:
    """The arrays of an .npz archive by name.

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
            return {member.filename.removesuffix(".npy"): _array(archive.read(member)) for member in members}
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, OSError, RuntimeError, KeyError):
        raise ValueError("not an archive of arrays") from None


def _array(data: bytes) -> NDArray[np.generic]:
    file = io.BytesIO(data)
    version = np.lib.format.read_magic(file)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, dtype = read(file)
    # Numpy would make room for what the header says before it looks for it.
    count = int(np.prod(np.array(shape, dtype=object))) if shape else 1
    if (
        dtype.hasobject
        or any(side < 0 for side in shape)
        or count * dtype.itemsize != len(data) - file.tell()
    ):
        raise ValueError("an array is not as large as it says")
    array = np.frombuffer(data, dtype, count, file.tell())
    return array.reshape(shape, order="F" if fortran else "C").copy()
