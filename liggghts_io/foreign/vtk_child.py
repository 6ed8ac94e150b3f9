"""Read VTK files for another process; a program of its own that knows nothing of this package.

A child process, because the readers of VTK end the whole process at some damaged files. It takes
one path in each line of its input and answers each with 8 bytes, the length of what follows, and
an `.npz` file: arrays by name, or `error`, a text. `points` are the positions (n, 3).
"""

from __future__ import annotations

import gzip
import io
import re
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
    b'type="PolyData"': "vtkXMLPolyDataReader",
    b'type="UnstructuredGrid"': "vtkXMLUnstructuredGridReader",
}


def _reader(content: bytes) -> Any:
    """Return the reader of a file by what it begins with, None for a kind without grains."""
    if content.startswith(b"# vtk DataFile"):
        reader = import_module("vtkmodules.vtkIOLegacy").vtkGenericDataObjectReader()
        reader.ReadFromInputStringOn()
        reader.SetBinaryInputString(content, len(content))
        return reader
    for word, name in _XML.items():
        if word in content[:_HEAD]:
            reader = getattr(import_module("vtkmodules.vtkIOXML"), name)()
            reader.ReadFromInputStringOn()
            reader.SetInputString(content)
            return reader
    return None


def read(path: str) -> dict[str, Any]:
    """Return the arrays of the points of a file, or what is wrong with it."""
    core = import_module("vtkmodules.vtkCommonCore")
    to_numpy = import_module("vtkmodules.util.numpy_support").vtk_to_numpy
    said = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(said)  # of this process, which has no other use
    content = Path(path).read_bytes()
    if content.startswith(b"\x1f\x8b"):
        content = gzip.decompress(content)
    reader = _reader(content)
    if reader is None:
        return {"error": "holds neither points nor an unstructured grid"}
    if _NO_GRAINS.search(content[:_HEAD]):
        return {"points": np.empty((0, 3))}
    reader.Update()
    found = reader.GetOutput()
    if said.GetOutput():
        return {"error": " ".join(said.GetOutput().split())}
    if found is None or not hasattr(found, "GetPoints"):
        return {"error": "holds neither points nor an unstructured grid"}
    points = found.GetPoints()
    arrays = {"points": to_numpy(points.GetData()) if points else np.empty((0, 3))}
    data = found.GetPointData()
    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        if array is not None and array.GetName() and array.GetName() not in ("points", "error"):
            arrays[array.GetName()] = to_numpy(array)
    return arrays


def main() -> None:
    """Answer every line of the input."""
    for line in sys.stdin.buffer:
        try:
            answer = read(line.decode().rstrip("\n"))
        except Exception as err:  # whatever it is, the other process tells it of its file
            answer = {"error": str(err)}
        packed = io.BytesIO()
        np.savez(packed, **answer)
        sys.stdout.buffer.write(len(packed.getvalue()).to_bytes(_WORD, "little"))
        sys.stdout.buffer.write(packed.getvalue())
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
