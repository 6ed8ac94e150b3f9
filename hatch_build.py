"""Put machine code of the engine into the package, so that its first run need not compile."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED = "minidem/kernels/shipped"


class ShippedCode(BuildHookInterface[Any]):
    """Compiles what nearly every script needs; without it the first script of a user compiles."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before files are collected; a machine that cannot gets a package without."""
        done = subprocess.run([sys.executable, "-m", "minidem.ship"], cwd=self.root)
        if done.returncode != 0:
            self.app.display_warning("no machine code is shipped: the first run will compile it")
            return
        build_data["artifacts"].append(f"/{SHIPPED}/*")
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
