"""The link's brain, without sockets, clocks or files: see `core.Session`."""
