"""What minidem would say of a script, without running it: ``minidem --check`` and ``--report``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from minidem.rehearsal import rehearse
from minidem.script import CaseFolder
from minidem.script.check.finding import Finding

__all__ = ["check_script", "findings_text", "is_refused"]

_SHOWN = 200  # characters of a line of the script that are shown
_MOST = 200  # findings that are shown


def check_script(
    script: Path, *, root: Path | CaseFolder, variables: Mapping[str, Sequence[str]] | None = None,
    strict: bool = False,
) -> tuple[Finding, ...]:  # fmt: skip
    """Find all lines of a script that minidem will not carry out; nothing is run or written.

    Parameters
    ----------
    script : Path
        Script file.
    root : Path or CaseFolder
        Folder of the case; files that the script reads are found in it.
    variables : mapping of str to sequence of str, optional
        Values for ``variable ... index``, as ``-var`` gives them.
    strict : bool
        Refuse the words that LIGGGHTS lacks, too.

    Returns
    -------
    tuple of Finding
        In the order in which the script gets to them. Lines in branches that are certainly not
        taken are not among them.

    Raises
    ------
    ScriptError
        If a value of `variables` is no variable, or the script cannot be read.
    """
    folder = root if isinstance(root, CaseFolder) else CaseFolder(root)
    return tuple(rehearse(script, folder, variables or {}, strict=strict))


def is_refused(findings: Sequence[Finding]) -> bool:
    """Tell whether the script would be refused before its first step."""
    return any(finding.refused for finding in findings)


def findings_text(script: str, findings: Sequence[Finding]) -> str:
    """Return what was found as text, one paragraph a line of the script."""
    if not findings:
        return f"{script}: minidem has all words of it\n"
    still = sum(not finding.moves for finding in findings)
    lines = "line" if len(findings) == 1 else "lines"
    parts = [
        f"{script}: {len(findings)} {lines} that minidem does not carry out, "
        f"{still} of them without influence on the motion",
        *map(_paragraph, findings[:_MOST]),
    ]
    if len(findings) > _MOST:
        parts.append(f"and {len(findings) - _MOST} more")
    if not is_refused(findings):
        parts.append("The script runs; lines above that it gets to are skipped or end the run.")
    elif not any(finding.refused and finding.moves for finding in findings):
        parts.append("Without the lines that are refused the motion is the same.")
    return "\n".join(parts) + "\n"


def _paragraph(found: Finding) -> str:
    """Return what is said of one line."""
    if found.skipped:
        fate = "skipped with a warning"
    elif found.missing_file and not found.certain:
        fate = "not there; ends the run unless it is made before the script gets to it"
    elif found.shared:
        fate = "ends the run if the script gets to it, in LIGGGHTS as well"
    elif found.missing_file:
        fate = "refused; put the file there or correct its name"
    else:
        fate = "refused" if found.certain else "ends the run if the script gets to it"
    motion = "may change the motion" if found.moves else "does not change the motion"
    error = found.error
    text = f"{error.file}:{error.line}: {error.message}\n    {fate}; {motion}"
    return text + (f"\n    | {found.text[:_SHOWN]}" if found.text else "")
