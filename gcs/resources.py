"""Where shipped files are, in an installed wheel and in a checkout: missions and policies."""

from __future__ import annotations

from pathlib import Path

POLICIES = ("default", "lab", "demo")
SUFFIXES = (".toml", ".plan", ".waypoints", ".txt", ".csv", ".kml", ".gpx")


class MissionNotFoundError(Exception):
    """No such file, and no shipped mission of that name.  `hint` names what is shipped."""

    def __init__(self, name: str, hint: str) -> None:
        super().__init__(f"{name}: no such mission file")
        self.hint = hint


def missions_dir() -> Path:
    """The folder of the shipped missions.  Raises FileNotFoundError if this copy has none."""
    package = Path(__file__).resolve().parent
    for folder in (package / "_missions", package.parent / "missions"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"no missions are shipped with this copy in {package}")


def shipped() -> list[str]:
    """Names of all shipped missions, relative to their folder: `demo.toml`, `lab3/square.toml`."""
    try:
        folder = missions_dir()
    except FileNotFoundError:
        return []
    files = (path for path in folder.rglob("*") if path.suffix in SUFFIXES)
    return sorted(path.relative_to(folder).as_posix() for path in files)


def find(name_or_path: str) -> Path:
    """A file as typed, or else the shipped mission of that name, with or without its suffix.

    `demo`, `demo.toml`, `missions/demo.toml` and `lab3/square` all find what is meant, from any
    folder.  Raises MissionNotFoundError.
    """
    path = Path(name_or_path)
    if path.is_file():
        return path
    wanted = name_or_path.replace("\\", "/").removeprefix("./").removeprefix("missions/")
    names = shipped()
    for name in names:
        if wanted == name or any(wanted + suffix == name for suffix in SUFFIXES):
            return missions_dir() / name
    raise MissionNotFoundError(name_or_path, f"shipped missions: {', '.join(names) or 'none'}")


def policy_path(name: str) -> Path:
    """The file of a shipped policy (`default`, `lab`), or the path as typed, there or not."""
    if name in POLICIES:
        return Path(__file__).resolve().parent / "gate" / "policy" / f"{name}.toml"
    return Path(name)
