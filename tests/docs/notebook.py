"""Run the tutorial notebook from its first cell to its last, as somebody who reads it would.

python -m tests.docs.notebook      # writes docs/tutorial.ipynb anew, with what it shows
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

from tests.paths import ROOT

TUTORIAL = ROOT / "docs" / "tutorial.ipynb"
LONGEST_S = 1800


def executed(folder: Path) -> Any:
    """Return the notebook as it stands after all its cells ran.

    Parameters
    ----------
    folder : Path
        Gets copies of what the notebook reads, and its results.
    """
    shutil.copytree(ROOT / "cases" / "plain_script", folder / "cases" / "plain_script")
    (folder / "docs").mkdir()
    notebook = nbformat.read(TUTORIAL, as_version=4)
    NotebookClient(
        notebook,
        timeout=LONGEST_S,
        kernel_name="python3",
        resources={"metadata": {"path": str(folder / "docs")}},
    ).execute()
    return notebook


def text_of(cell: Any) -> str:
    """Return all plain text that a cell shows."""
    parts = [output.get("text", "") for output in cell.outputs]
    parts += [output.get("data", {}).get("text/plain", "") for output in cell.outputs]
    return "\n".join(part for part in parts if part)


def main() -> None:
    """Write the notebook anew."""
    with tempfile.TemporaryDirectory() as folder:
        notebook = executed(Path(folder))
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
        cell.metadata = {}
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    nbformat.write(notebook, TUTORIAL)


if __name__ == "__main__":
    main()
