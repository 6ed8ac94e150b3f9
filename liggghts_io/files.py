"""Write files so that a reader never sees half of one, and hash what is written."""

from __future__ import annotations

import codecs
import fcntl
import hashlib
import json
import os
import shlex
import stat
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from difflib import get_close_matches
from itertools import islice
from pathlib import Path
from typing import Any, Final

UTF_16_MARKS: Final = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_MOST_LISTED: Final = 10_000  # names of a folder that are compared
_ITS_OWNER: Final = 0o600


def write_text(path: Path, text: str) -> None:
    """Write `text` to a temporary name in the same folder, then rename it to `path`."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> None:
    """Write `content` to a temporary name in the same folder, then rename it to `path`.

    Raises
    ------
    OSError
        As `replacing`.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as temporary:
        temporary.write_bytes(content)


@contextmanager
def replacing(path: Path, suffix: str = "") -> Iterator[Path]:
    """Write a file in a ``with`` block under a temporary name that becomes `path` at its end.

    A file that is replaced keeps its rights. When the block fails, on a full disk for example, the
    temporary file is gone and `path` is as it was.

    Parameters
    ----------
    path : Path
        In a folder that is there.
    suffix : str, optional
        End of the temporary name, for programs that know by it what to write.

    Yields
    ------
    Path
        An empty file in the same folder.

    Raises
    ------
    OSError
        When nothing can be written there, before the block, and when the block fails in that way;
        it names `path`, not the temporary file.
    """
    # Without the file's own name, which may be as long as a name can be.
    temporary = path.with_name(f".{uuid.uuid4().hex}.tmp{suffix}")
    try:
        if path.exists():
            temporary.touch(mode=_ITS_OWNER)  # nobody reads it before it has the rights
        else:
            temporary.touch()
        yield temporary
        if path.exists():
            temporary.chmod(stat.S_IMODE(path.stat().st_mode))
        os.replace(temporary, path)  # noqa: PTH105 - the atomic rename is the point
    except BaseException as err:
        with suppress(OSError):  # what failed first is what to tell
            temporary.unlink(missing_ok=True)
        if isinstance(err, OSError) and err.filename in (None, str(temporary)):
            err.filename = str(path)
            if err.filename2 is not None:
                del err.filename2
        raise


@contextmanager
def alone_with(path: Path) -> Iterator[None]:
    """Keep other processes that ask for the same from reading and replacing a file in a block.

    Parameters
    ----------
    path : Path
        A file, or where one will be, in a folder that is there. While the block lasts a hidden file
        lies beside it, which is locked; the lock dies with its process.

    Raises
    ------
    OSError
        If nothing can be written there, or the file system has no locks.
    """
    path = path.resolve()
    beside = path.with_name(f".{path.name}.lock")
    while True:
        with beside.open("ab") as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            if not _is_at(held.fileno(), beside):
                continue  # who had it before took it away
            try:
                yield
                return
            finally:
                beside.unlink(missing_ok=True)


def _is_at(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat())
    except FileNotFoundError:
        return False


def shell_word(path: Path | str) -> str:
    """Return a path as it is typed in a command: in quotes where it holds spaces or the like.

    Double ones where they do, since messages have commands in single ones. One that begins with a
    minus sign would be taken for an option, and gets its folder.

    Examples
    --------
    >>> shell_word("runs/heap"), shell_word("my run"), shell_word("-heap")
    ('runs/heap', '"my run"', './-heap')
    """
    word = f"./{path}" if str(path).startswith("-") else str(path)
    quoted = shlex.quote(word)
    return quoted if quoted == word or set('"$`\\!') & set(word) else f'"{word}"'


def nearest_file(path: Path) -> str:
    """Return the hint that ends a message about a file that is not there.

    Parameters
    ----------
    path : Path

    Returns
    -------
    str
        The file of that folder with the most alike name as a question; nothing where none is near,
        or where the folder cannot be listed.
    """
    try:
        if path.exists():
            return ""
        names = [one.name for one in islice(path.parent.iterdir(), _MOST_LISTED)]
    except (OSError, ValueError, RuntimeError):  # ValueError: NUL; RuntimeError: loop of links
        return ""
    close = get_close_matches(path.name, names, n=1)
    return f"; did you mean {str(path.with_name(close[0]))!r}?" if close else ""


def table_text(raw: bytes) -> str:
    """Return the text of a table as programs save it.

    UTF-8 with and without a byte order mark, UTF-16 with one, and Windows' western European
    letters (of which Latin-1 is a part) where it is no UTF-8: a table holds few words, and the
    numbers are the same in all of them.

    Raises
    ------
    UnicodeDecodeError
        When it is no text.

    Examples
    --------
    >>> table_text("Größe".encode("cp1252")), table_text("Größe".encode("utf-16"))
    ('Größe', 'Größe')
    """
    if raw.startswith(UTF_16_MARKS):
        return raw.decode("utf-16")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252")


def canonical_json(value: Any) -> str:
    """Return JSON with sorted keys and no spaces; NaN and infinity are refused."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def sha256_text(text: str) -> str:
    """Return the hexadecimal sha256 of a text in UTF-8."""
    return sha256_bytes(text.encode("utf-8"))


def sha256_bytes(content: bytes) -> str:
    """Return the hexadecimal sha256 of bytes."""
    return hashlib.sha256(content).hexdigest()


def sha256_file(path: Path) -> str:
    """Return the hexadecimal sha256 of a file."""
    with path.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def signed_json(key: str, value: Any) -> str:
    """Return a JSON text that holds `value` under `key`, and its sha256."""
    signed = {key: value, "sha256": sha256_text(canonical_json(value))}
    return json.dumps(signed, indent=1, sort_keys=True) + "\n"


def read_signed_json(path: Path, key: str) -> Any:
    """Return what `signed_json` wrote to a file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is no such text, or was changed; the message says what is wrong.
    """
    try:
        signed = json.loads(path.read_bytes().decode("utf-8"))
        value, digest = signed[key], signed["sha256"]
        actual = sha256_text(canonical_json(value))
    except (KeyError, TypeError, RecursionError) as err:
        msg = f"the entry {err} is missing or has another form"
        raise ValueError(msg) from err
    if actual != digest:
        msg = "the content does not match its hash"
        raise ValueError(msg)
    return value
