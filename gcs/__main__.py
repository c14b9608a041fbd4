"""`python -m gcs`: the same as the `gcs` command, where the script is not on the path."""

from __future__ import annotations

from gcs.cli.main import main

if __name__ == "__main__":
    main()
