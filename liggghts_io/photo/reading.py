"""Read a photograph, whatever camera or program wrote it, and refuse what is none.

A stranger's file is looked at before it is decoded: only plain files, only the decoders of common
pictures (none that runs another program, as EPS would), and no more pixels than memory holds.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt
from PIL import Image, ImageOps, UnidentifiedImageError

from liggghts_io.errors import CaseError
from liggghts_io.files import nearest_file

ColourImage = npt.NDArray[np.uint8]

FORMATS: Final = ("JPEG", "PNG", "TIFF", "BMP", "WEBP", "PPM")
MOST_PIXELS: Final = 80_000_000  # of a photograph; its analysis takes 2 GB of memory then
MOST_BYTES: Final = 1_000_000_000
LEAST_SIDE: Final = 32  # pixels
_HEIF: Final = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1", b"avif")
_DEEP_MODES: Final = ("I", "F", "I;16", "I;16L", "I;16B", "I;16N")  # one channel, above 8 bit


def read_photo(path: Path) -> ColourImage:
    """Return the pixels of a photograph, turned as its camera was held.

    Parameters
    ----------
    path : Path
        JPEG, PNG, TIFF, BMP, WebP or PPM; of several pictures in a file the first.

    Returns
    -------
    (rows, columns, 3) uint8
        Red, green, blue. Deeper pictures are stretched to 8 bit, transparent ones laid on black or
        white, whichever differs more from what is seen.

    Raises
    ------
    CaseError
        If the file is no picture, is cut, is too large or too small, or cannot be read.
    """
    _check_file(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # damaged tags of a camera; sizes are checked below
            with Image.open(path, formats=FORMATS) as opened:
                _check_size(path, opened.size)
                return _pixels(opened, path)
    except CaseError:
        raise
    except UnidentifiedImageError as err:
        msg = f"{path}: is no picture that can be read; {_remedy(path)}"
        raise CaseError(msg) from err
    except Image.DecompressionBombError as err:
        msg = f"{path}: has far more than {MOST_PIXELS / 1e6:.0f} million pixels; make it smaller"
        raise CaseError(msg) from err
    except PermissionError as err:
        msg = f"{path}: may not be read ({err.strerror}); ask for the permission"
        raise CaseError(msg) from err
    # Decoders meet damaged bytes with exceptions of every kind; none of them is a fault of ours.
    except Exception as err:
        reason = " ".join(str(err).split()) or type(err).__name__
        msg = f"{path}: is cut or damaged ({reason[:120]}); copy it from the camera again"
        raise CaseError(msg) from err


def _check_file(path: Path) -> None:
    """Refuse what is no plain file of a sensible length, before it is opened."""
    try:
        there, plain = path.exists(), path.is_file()
        length = path.stat().st_size if plain else 0
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); name a photograph"
        raise CaseError(msg) from err
    if not there:
        msg = f"{path}: no such file{nearest_file(path)}; name a photograph"
        raise CaseError(msg)
    if not plain:
        msg = f"{path}: is no file; name a photograph"
        raise CaseError(msg)
    if length == 0:
        msg = f"{path}: is empty; copy it from the camera again"
        raise CaseError(msg)
    if length > MOST_BYTES:
        msg = f"{path}: has {length / 1e9:.1f} GB, at most {MOST_BYTES / 1e9:.0f} GB can be read"
        raise CaseError(msg)


def _check_size(path: Path, size: tuple[int, int]) -> None:
    columns, rows = size
    if columns * rows > MOST_PIXELS:
        msg = (
            f"{path}: {columns} x {rows} pixels, at most {MOST_PIXELS / 1e6:.0f} million can be "
            "measured; cut out a part of it, or make it smaller and give the scale of that"
        )
        raise CaseError(msg)
    if min(columns, rows) < LEAST_SIDE:
        msg = f"{path}: {columns} x {rows} pixels, too few; at least {LEAST_SIDE} on each side"
        raise CaseError(msg)


def _remedy(path: Path) -> str:
    """Return what to do about a file that no decoder knows."""
    if path.suffix.lower() in (".heic", ".heif") or _is_heif(path):
        return (
            "it is HEIC, whatever its name: set the phone to JPEG ('most compatible'), or export "
            "the picture as JPEG"
        )
    return "save it as PNG or JPEG"


def _is_heif(path: Path) -> bool:
    """Whether a file begins as the pictures of phones do, whatever its name says."""
    with path.open("rb") as opened:
        head = opened.read(12)
    return head[4:8] == b"ftyp" and head[8:12] in _HEIF


def _pixels(opened: Image.Image, path: Path) -> ColourImage:
    opened.load()
    upright = ImageOps.exif_transpose(opened)
    if upright.mode in _DEEP_MODES:
        return _stretched(np.asarray(upright), path)
    if "A" in upright.getbands() or "a" in upright.getbands() or "transparency" in upright.info:
        return _laid_on_ground(np.asarray(upright.convert("RGBA")), path)
    return np.asarray(upright.convert("RGB"))


def _stretched(deep: npt.NDArray[np.generic], path: Path) -> ColourImage:
    """Return a picture of more than 8 bit as one of 8 bit that uses all of them."""
    values = deep.astype(np.float32)
    if not np.isfinite(values).all():
        msg = f"{path}: holds pixels that are no number; save it as PNG or JPEG"
        raise CaseError(msg)
    quiet = cv2.medianBlur(values, 3)  # single hot pixels set no limit
    low, high = float(quiet.min()), float(quiet.max())
    grey = np.clip((values - low) * (255.0 / max(high - low, 1e-30)), 0, 255).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


def _laid_on_ground(pixels: ColourImage, path: Path) -> ColourImage:
    """Return a picture with transparency as it looks on the ground that shows it best."""
    colour, opaque = pixels[:, :, :3].astype(np.float32), pixels[:, :, 3:].astype(np.float32) / 255
    if not opaque.any():
        msg = f"{path}: is wholly transparent; save it without an alpha channel"
        raise CaseError(msg)
    mean = float((colour * opaque).sum() / (3.0 * opaque.sum()))
    ground = 255.0 if mean < 127.5 else 0.0
    return np.asarray(np.round(colour * opaque + ground * (1.0 - opaque)), dtype=np.uint8)
