"""What the gate asks about the fence, a file a subject; `verifier.py` is what is asked."""
