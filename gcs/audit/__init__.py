"""The audit: what a station recorded, done again by a fresh session, and compared.

`audit(messages, attachments) -> AuditResult` is pure; `gcs/cli/log/audit.py` reads the files.

    messages ─▶ seals.py ─▶ turns.py ─▶ replay.py ─▶ compare.py ─▶ AuditResult
                are they    one input   a session    what differs,
                all there?  and what    and a        in words.py's
                            was made    recorder     words
                            of it
"""
