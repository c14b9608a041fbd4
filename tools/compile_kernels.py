"""Compile the simulated vehicle's kernels with mypyc: the same source, the same bytes.

    python -m tools.compile_kernels FOLDER

FOLDER gets `vehicle_sim` with its compiled modules beside their sources: PYTHONPATH=FOLDER flies
with them.  `hatch_build.py` puts them into a wheel in the same way.  It needs mypy and a C
compiler.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[1]
ROOMS: Final = ("numerics", "plant", "estimation", "control_loops", "engine")
NO_KERNELS: Final = frozenset(
    {"__init__", "airframe", "batch_engine", "choose_engine", "faults", "kernel", "lanes", "truth"}
)
"""Modules of these rooms that no step of a vehicle runs."""


def sources() -> list[str]:
    """What is compiled, by its path from the root."""
    found = (path for room in ROOMS for path in (ROOT / "vehicle_sim" / room).glob("*.py"))
    return sorted(str(path.relative_to(ROOT)) for path in found if path.stem not in NO_KERNELS)


def compile_kernels(folder: Path) -> list[Path]:
    """Put the compiled modules into `folder`, by their packages; their paths there."""
    from mypyc.build import mypycify
    from setuptools import Distribution

    asked = ["--config-file=", "--explicit-package-bases", "--follow-imports=silent", *sources()]
    modules = mypycify(asked, opt_level="3", target_dir=str(folder / "build"))
    for module in modules:
        if sys.platform != "win32":
            # Nowhere a product and a sum in one rounding: every machine has the same bytes.
            module.extra_compile_args.append("-ffp-contract=off")
    distribution = Distribution({"name": "mavgate", "ext_modules": modules})
    command = distribution.get_command_obj("build_ext")
    command.build_lib, command.build_temp = str(folder), str(folder / "build")
    distribution.run_command("build_ext")
    shutil.rmtree(folder / "build")
    return sorted(path for path in folder.rglob("*") if path.suffix in (".so", ".pyd"))


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    folder = Path(sys.argv[1]).resolve()
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(
        ROOT / "vehicle_sim", folder / "vehicle_sim", ignore=ignored, dirs_exist_ok=True
    )
    print(f"{len(compile_kernels(folder))} compiled modules in {folder}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
