"""Reads the logs that autopilots write themselves: DataFlash, binary and text, and ULog."""
