"""What MAVLink clients may change of a vehicle's set-up, by the policy's section `[bridge]`."""
