"""Further sections of a report, also for a report that is already written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from html import escape, unescape
from pathlib import Path

from calibrate.errors import CalibrationError
from liggghts_io.files import write_text

__all__ = ["LINKS_END", "SECTIONS_END", "Section", "add_section", "further_sections"]

LINKS_END = "<!-- end of links -->"
SECTIONS_END = "<!-- end of further sections -->"

_SECTION = re.compile(r'<section id="([^"]*)">\n<h2>(.*?)</h2>\n(.*?)\n</section><!-- \1 -->', re.S)


@dataclass(frozen=True)
class Section:
    """A section of a report, for example a diagnosis.

    Attributes
    ----------
    title : str
    html : str
        Put in as it is: whoever makes it escapes what came from outside.
    """

    title: str
    html: str

    @property
    def anchor(self) -> str:
        """Name of the section in links."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


def _section_html(section: Section) -> tuple[str, str]:
    """Return the link to a section and the section itself, as HTML."""
    title, anchor = escape(section.title), section.anchor
    link = f'<a href="#{anchor}">{title}</a>'
    body = f'<section id="{anchor}">\n<h2>{title}</h2>\n{section.html}\n</section><!-- {anchor} -->'
    return link, body


def add_section(report: Path, section: Section) -> Path:
    """Add a section to a report, or replace the one of the same title.

    Parameters
    ----------
    report : Path
        File that `write_report` wrote; replaced as a whole.
    section : Section

    Raises
    ------
    CalibrationError
        When the file is missing or is no report.
    """
    try:
        text = report.read_text(encoding="utf-8")
    except OSError as err:
        msg = f"{report}: no report there ({err.strerror}); make one with 'bulkcal calibrate'"
        raise CalibrationError(msg) from err
    if LINKS_END not in text or SECTIONS_END not in text:
        msg = f"{report}: not a calibration report; make one with 'bulkcal calibrate'"
        raise CalibrationError(msg)
    link, body = _section_html(section)
    anchor = re.escape(section.anchor)
    text = re.sub(
        rf'<section id="{anchor}">.*?</section><!-- {anchor} -->\n?', "", text, flags=re.S
    )
    text = re.sub(rf'<a href="#{anchor}">.*?</a>', "", text)
    text = text.replace(LINKS_END, link + LINKS_END).replace(
        SECTIONS_END, f"{body}\n{SECTIONS_END}"
    )
    write_text(report, text)
    return report


def further_sections(report: Path) -> list[Section]:
    """Return the sections that were added to a report; none where there is no report."""
    try:
        text = report.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return []
    return [Section(unescape(title), html) for _, title, html in _SECTION.findall(text)]
