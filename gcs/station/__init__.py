"""The composition of vehicles, operators, links and the bridge: see `session.Session`."""
