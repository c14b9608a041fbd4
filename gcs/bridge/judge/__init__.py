"""What is done with one frame of a client that is for the vehicle, or for everybody.

`judge.py` tells by the kind of its message or command (`catalog/`): it is forwarded, refused, or
given to one of the others.
"""
