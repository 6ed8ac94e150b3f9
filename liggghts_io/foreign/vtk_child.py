"""Read VTK files for another process; a program of its own that knows nothing of this package.

A child process, because the readers of VTK end the whole process at some damaged files. It takes
one path in each line of its input and answers each with 8 bytes, the length of what follows, and
an `.npz` file: `points`, the positions (n, 3), `names`, and the arrays "0", "1" ... of these names;
or a text: `said` by VTK, or `error`, what is wrong in our words.
"""

from __future__ import annotations

import gzip
import io
import os
import re
import resource
import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

_WORD: Final = 8  # bytes of a length
_HEAD: Final = 2000  # bytes in which the kind of a file stands
_NO_GRAINS: Final = re.compile(rb"\nPOINTS 0 [a-z]+\s*(\n|$)")
"""All that LIGGGHTS writes of a frame without grains; VTK takes it for a fault."""
_XML: Final = {
    re.compile(rb"""type=["']PolyData["']"""): "vtkXMLPolyDataReader",
    re.compile(rb"""type=["']UnstructuredGrid["']"""): "vtkXMLUnstructuredGridReader",
}
_TEXT: Final = re.compile(rb"# vtk DataFile[^\n]*\n[^\n]*\nASCII\s", re.IGNORECASE)
_NO_POINTS: Final = "holds neither points nor an unstructured grid"
_POINT_CELLS: Final = (0, 1, 2)  # empty, vertex, several of them
_MEMORY: Final = 1 << 30  # bytes that a small file may take
_TIMES: Final = 100  # bytes of memory for each byte of a file, compressed ones too


def _reader(content: bytes) -> Any:
    """Return the reader of a file by what it begins with, None for a kind without grains."""
    if content.startswith(b"# vtk DataFile"):
        reader = import_module("vtkmodules.vtkIOLegacy").vtkGenericDataObjectReader()
        reader.ReadFromInputStringOn()
        reader.SetBinaryInputString(content, len(content))
        for kind in ("Scalars", "Vectors", "Normals", "Tensors", "Fields"):
            getattr(reader, f"ReadAll{kind}On")()  # without it only the first of each kind is read
        return reader
    for word, name in _XML.items():
        if word.search(content[:_HEAD]):
            reader = getattr(import_module("vtkmodules.vtkIOXML"), name)()
            reader.ReadFromInputStringOn()
            reader.SetInputString(content.removeprefix(b"\xef\xbb\xbf"))
            return reader
    return None


def _limit_memory(size: int) -> None:
    """Allow the memory that a file of so many bytes can need, beside what is there already.

    A number of points that lies would take all there is.
    """
    statistics = Path("/proc/self/statm")
    if not statistics.exists():
        return  # not Linux, where nothing else tells how much is there
    pages = int(statistics.read_text().split()[0])
    soft = pages * resource.getpagesize() + _MEMORY + _TIMES * size
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (soft if hard < 0 else min(soft, hard), hard))


def _content(path: str) -> bytes:
    """Return what stands in a file, decompressed.

    Raises
    ------
    ValueError
        With why VTK is not asked: there is nothing, or a text ends within a line.
    """
    content = Path(path).read_bytes()
    _limit_memory(len(content))
    if content.startswith(b"\x1f\x8b"):
        content = gzip.decompress(content)
    if not content.strip():
        msg = "it is empty"
        raise ValueError(msg)
    # VTK would give what lies in memory for numbers that are missing behind such a line.
    if _TEXT.match(content[:_HEAD]) and not content.endswith(b"\n"):
        msg = "its last line has no end, as where a file is cut"
        raise ValueError(msg)
    return content


def read(path: str) -> dict[str, Any]:
    """Return the arrays of the points of a file, or what is wrong with it."""
    core = import_module("vtkmodules.vtkCommonCore")
    to_numpy = import_module("vtkmodules.util.numpy_support").vtk_to_numpy
    said = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(said)  # of this process, which has no other use
    content = _content(path)
    reader = _reader(content)
    if reader is None:
        return {"error": _NO_POINTS}
    if _NO_GRAINS.search(content[:_HEAD]):
        return {"points": np.empty((0, 3)), "names": np.empty(0, dtype=np.str_)}
    reader.Update()
    found = reader.GetOutput()
    if said.GetOutput():
        return {"said": " ".join(said.GetOutput().split())}
    if found is None or not hasattr(found, "GetPoints"):
        return {"error": _NO_POINTS}
    if _has_cells(found, to_numpy):
        return {"error": "holds surfaces or lines, not grains"}
    points = found.GetPoints()
    answer = {"points": to_numpy(points.GetData()) if points else np.empty((0, 3))}
    data = found.GetPointData()
    arrays = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
    named = [array for array in arrays if array is not None and array.GetName()]
    answer |= {str(k): to_numpy(array) for k, array in enumerate(named)}
    return answer | {"names": np.array([array.GetName() for array in named], dtype=np.str_)}


def _has_cells(found: Any, to_numpy: Any) -> bool:
    """Whether there are other cells than points."""
    if hasattr(found, "GetNumberOfPolys"):
        counts = (found.GetNumberOfPolys(), found.GetNumberOfLines(), found.GetNumberOfStrips())
        return any(counts)
    types = found.GetCellTypesArray() if hasattr(found, "GetCellTypesArray") else None
    return types is not None and not np.isin(to_numpy(types), _POINT_CELLS).all()


def main() -> None:
    """Answer every line of the input."""
    for line in sys.stdin.buffer:
        try:
            answer = read(os.fsdecode(line.removesuffix(b"\n")))
        except MemoryError:
            answer = {"error": "needs more memory than a file of this size can"}
        except Exception as err:  # whatever it is, the other process tells it of its file
            answer = {"error": f"cannot be read ({str(err) or type(err).__name__})"}
        packed = io.BytesIO()
        np.savez(packed, **answer)
        sys.stdout.buffer.write(len(packed.getvalue()).to_bytes(_WORD, "little"))
        sys.stdout.buffer.write(packed.getvalue())
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
