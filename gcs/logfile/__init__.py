"""Work on finished logs: columns, import, export.  Nothing of it runs in the station's process."""
