"""The session's clock and the other side's: every wait for an answer is made here, once.

A session may run faster or slower than real time (`--speedup`), and so does its vehicle.  What the
vehicle flies takes as long on the session's clock as on its own.  What crosses the link does not:
an answer, a heartbeat or a lost datagram takes real time, and that is `speedup` times as long on
the session's clock.
"""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import structs

from gcs.gate.policy.policy import ControlTimes, Policy, TakeOffLimits


@dataclass(frozen=True, slots=True)
class Times:
    """`speedup` is how many times as fast as real time the session's clock runs."""

    speedup: float = 1.0

    def real_ns(self, ns: int) -> int:
        """That many nanoseconds of real time, on the session's clock."""
        return round(ns * self.speedup)

    def real_s(self, session_ns: int) -> float:
        """How many real seconds a span on the session's clock is."""
        return session_ns / 1e9 / self.speedup

    def policy(self, policy: Policy) -> Policy:
        """`policy`, whose waits for heartbeats, answers, pictures, positions and samples of a
        stream, and for a person, are real time.

        What the vehicle flies or does by itself meanwhile (a climb, a landing, a start of the
        estimator) takes as long on both clocks; its report comes in real time.  So such a wait is
        never shorter than the policy says, on either clock.
        """
        times, stream, faster = policy.control, policy.stream, self.speedup
        no_less = max(1.0, faster)
        return structs.replace(
            policy,
            heartbeat_age_s=policy.heartbeat_age_s * faster,
            position_age_s=policy.position_age_s * no_less,
            stale_grace_s=policy.stale_grace_s * no_less,
            deadline_min_s=policy.deadline_min_s * no_less,
            arm_timeout_s=policy.arm_timeout_s * no_less,
            land_timeout_s=policy.land_timeout_s * no_less,
            photo_timeout_s=policy.photo_timeout_s * no_less,
            takeoff=TakeOffLimits(policy.takeoff.max_up_m, policy.takeoff.timeout_s * no_less),
            stream=structs.replace(
                stream,
                deadman_s=stream.deadman_s * no_less,
                good_again_s=stream.good_again_s * no_less,
                ends_after_s=stream.ends_after_s * no_less,
                position_age_s=stream.position_age_s * no_less,
            ),
            control=ControlTimes(
                stream_s=times.stream_s * faster,
                timeout_s=times.timeout_s * faster,
                hold_every_s=times.hold_every_s * faster,
                disarm_wait_s=times.disarm_wait_s * no_less,
                force_repeat_s=times.force_repeat_s * faster,
            ),
        )
