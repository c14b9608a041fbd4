"""The report of a recorded flight: what it was, what went wrong first, as a page and as JSON.

    open_log ────▶ scan ─▶ Flight (what the flight was)      ─▶ page.html, one self-contained file
    the records     one     └ findings (what went wrong)     ─▶ JSON
    of a file       pass

Nothing here is imported by the station.  Times named `t_s` are seconds since the first message of
the file, positions are east, north, up of the local origin, in metres.
"""
