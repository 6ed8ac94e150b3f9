"""Write a study file."""

from __future__ import annotations

from calibrate.study.model import Study

__all__ = ["study_text"]


def study_text(study: Study, header: str = "") -> str:
    """Return `study` as TOML text that `load_study` reads back to an equal study.

    Parameters
    ----------
    study : Study
        Study to write.
    header : str
        Comment on top, without the comment signs.
    """
    data = study.model_dump(exclude_defaults=True)
    lines = [f"# {line}" for line in header.splitlines()]
    tables = ("bulk", "fixed", "effects", "published")
    lists = ("target", "curve", "stage")
    lines += [
        f"{k} = {_toml(v)}"
        for k, v in data.items()
        if k not in (*tables, *lists, "apparatus", "known")
    ]
    for key in tables:
        lines += _table(key, data.get(key, {}))
    for group in ("apparatus", "known"):
        for key, values in data.get(group, {}).items():
            lines += _table(f"{group}.{key}", values)
    for key in lists:
        for item in data.get(key, []):
            free = item.pop("free", {})
            lines += ["", f"[[{key}]]", *(f"{k} = {_toml(v)}" for k, v in item.items())]
            lines += _table(f"{key}.free", free)
    return "\n".join(lines) + "\n"


def _table(key: str, values: dict[str, object]) -> list[str]:
    return ["", f"[{key}]", *(f"{k} = {_toml(v)}" for k, v in values.items())] if values else []


def _toml(value: object) -> str:
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return repr(value)
