"""MAVLink clients of the station: what they send is judged, what they may is done, all is answered.

A client speaks MAVLink as if the station were the vehicle.  What it asks for becomes the words that
operators use (`gcs/ipc.py`), so the same gate decides; what it is told becomes MAVLink again.
"""
