"""Compiled kernels in a wheel, where they are asked for: HATCH_BUILD_HOOK_ENABLE_CUSTOM=1.

Without that nothing of this is run, and neither a compiler nor mypy is needed.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CompiledKernels(BuildHookInterface[Any]):
    """Adds the modules that `tools/compile_kernels.py` makes."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        sys.path.insert(0, self.root)
        from tools.compile_kernels import compile_kernels

        folder = Path(self.directory).resolve() / "compiled"
        for module in compile_kernels(folder):
            build_data["force_include"][str(module)] = str(module.relative_to(folder))
        build_data["pure_python"], build_data["infer_tag"] = False, True
