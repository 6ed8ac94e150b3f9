"""The diagnosis as a section of the report."""

from __future__ import annotations

import base64
from html import escape

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.diagnose.residuals import Residual
from calibrate.report.diagnosis_words import sentences

TITLE = "What the simulation gets wrong"
_STYLE = (
    "body{font-family:sans-serif;max-width:70rem;margin:2rem auto}"
    "td,th{padding:0 1ex;text-align:right}td:first-child{text-align:left}"
)


def section_html(found: Diagnosis, figure: bytes) -> str:
    """Return figure, sentences and tables as HTML; everything from outside is escaped.

    Parameters
    ----------
    found : Diagnosis
    figure : bytes
        PNG of `diagnosis_figure`.
    """
    image = base64.b64encode(figure).decode("ascii")
    said = sentences(found)
    parts = [
        f"<p><strong>{escape(said[0])}</strong></p>",
        f'<p><img alt="residuals and candidate causes" style="max-width:100%" '
        f'src="data:image/png;base64,{image}"></p>',
        "<ul>" + "".join(f"<li>{escape(line)}</li>" for line in said[1:]) + "</ul>",
        "<h3>Measured and simulated, all parameters refitted</h3>",
        _residual_table(found.residuals),
        "<h3>What each cause would look like</h3>",
        _absorption_table(found),
    ]
    if found.engine_before:
        parts += ["<h3>The engine at the refitted parameters</h3>"]
        parts += [_residual_table(found.engine_before)]
    if found.engine_after:
        parts += [f"<h3>The engine with {escape(found.verdict.names[0])}</h3>"]
        parts += [_residual_table(found.engine_after)]
    return "\n".join(parts)


def page_html(section: str) -> str:
    """Return a section of `section_html` as a page of its own."""
    head = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>'
    body = f"<body><h1>{TITLE}</h1>{section}</body>"
    return f"{head}<style>{_STYLE}</style></head>{body}</html>\n"


def _table(head: list[str], rows: list[list[str]]) -> str:
    top = "".join(f"<th>{escape(h)}</th>" for h in head)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def _residual_table(rows: tuple[Residual, ...]) -> str:
    head = ["observable", "measured", "± se", "simulated", "± se", "z", "z left out"]
    return _table(
        head,
        [
            [
                r.name,
                f"{r.measured:.4g}",
                f"{r.measured_sd:.2g}",
                f"{r.simulated:.4g}",
                f"{r.simulated_sd:.2g}",
                f"{r.z:+.1f}",
                f"{r.z_left_out:+.1f}",
            ]
            for r in rows
        ],
    )


def _absorption_table(found: Diagnosis) -> str:
    head = ["cause", "absorbed", "seen from", "plausible up to", "looks like"]
    return _table(
        head,
        [
            [
                v.candidate,
                f"{100 * v.absorbed:.0f} %",
                f"{v.detectable:.3g}",
                f"{v.limit:.3g}",
                ", ".join(v.alike) or "-",
            ]
            for v in found.absorption.candidates
        ],
    )
