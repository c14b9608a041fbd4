"""A client port with a key: what a peer gets, and can do, before its first good signature."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.audit.audit import audit
from gcs.audit.messages import Tape
from gcs.record.writer import Recorder
from gcs.report import InputItem
from gcs.session import inputs
from gcs.session.effects import ClientVerified, Effect
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import BridgedFlight, Client
from tests.loopback.flight import Flight
from tests.loopback.observed import START_NS
from tests.loopback.test_signed_bridge import ARM, CLIENT_KEY, LAND, OTHER, flown, signing

MINUTE_NS = 60 * 10**9


class Door(BridgedFlight):
    """A flight behind a port with a key, as the station is told of it by its shell."""

    def __init__(self) -> None:
        self.verified: list[int] = []
        self.bytes_to: list[tuple[int, bytes]] = []
        """Everything that clients were sent, by link."""
        super().__init__(client_key=CLIENT_KEY)

    def comes(self, sysid: int, key: bytes | None = None) -> Client:
        """A peer is taken in; it has said nothing yet."""
        link = 1 + len(self.clients)
        client = self.clients[link] = Client(self, link, sysid, 190)
        name = f"udp 127.0.0.1:{40000 + link}"
        self.feed(inputs.ClientCame(link, name, stream=False, verified=False))
        return client if key is None else signing(client, key)

    def _carry_out(self, effect: Effect) -> list[inputs.Input]:
        if isinstance(effect, ClientVerified):
            self.verified.append(effect.link)
        return super()._carry_out(effect)

    def to_client(self, link: int, data: bytes) -> None:
        self.bytes_to.append((link, data))
        super().to_client(link, data)

    def sent_to(self, client: Client) -> list[Frame]:
        """Read without a look at signatures."""
        mine = [data for link, data in self.bytes_to if link == client.link]
        return [item for data in mine for item in split(data) if isinstance(item, Frame)]

    def kinds(self, client: Client) -> set[str]:
        return {frame.name for frame in self.sent_to(client)}


def test_a_peer_hears_heartbeats_alone_until_it_signs() -> None:
    flight = Door()
    flight.connected()
    stranger, impostor, owner = flight.comes(246), flight.comes(247, OTHER), flight.comes(245)
    for _ in range(3):
        for client in (stranger, impostor):
            client.beat()
            client.command(ARM, 1)
            client.command(LAND)
        flight.run(1.0)
    assert not flight.verified
    assert flight.kinds(stranger) == flight.kinds(owner) == flight.kinds(impostor) == {"HEARTBEAT"}
    assert {(frame.sysid, frame.compid) for frame in flight.sent_to(stranger)} == {(1, 1)}
    assert 3 <= len(flight.sent_to(stranger)) <= 4
    assert not flight.decisions()
    signing(owner, CLIENT_KEY)
    owner.beat()
    flown(flight, owner)
    assert flight.verified == [owner.link]
    assert flight.kinds(owner) >= {"HEARTBEAT", "COMMAND_ACK", "STATUSTEXT", "LOCAL_POSITION_NED"}
    assert flight.kinds(stranger) == {"HEARTBEAT"}
    assert flight.kinds(impostor) == {"HEARTBEAT"}


def test_the_page_and_the_log_tell_who_is_not_verified() -> None:
    flight = Door()
    flight.connected()
    stranger, _, owner = flight.comes(246), flight.comes(247), flight.comes(245, CLIENT_KEY)
    stranger.beat()
    owner.beat()
    flight.run(1.5)
    rows = flight.of(ipc.BridgeStatus)[-1].clients
    assert [(row.verified, row.signed) for row in rows] == [
        (False, "1 unsigned"),
        (False, ""),
        (True, "signed"),
    ]
    told = "\n".join(flight.told())
    assert "udp 127.0.0.1:40001 has connected, on link 1, not verified" in told
    assert "udp 127.0.0.1:40003, on link 3, is verified" in told
    assert "link 1: 1 frame unsigned, refused: 246/190 HEARTBEAT" in told


def test_a_client_whose_signing_clock_is_behind_is_brought_on() -> None:
    flight = Door()
    flight.connected()
    owner = flight.comes(245, CLIENT_KEY)
    owner.mav.signing.timestamp -= 10 * MINUTE_NS // 10_000
    owner.beat()
    assert not flight.verified
    flight.run(2.0)
    assert flight.kinds(owner) == {"HEARTBEAT"}
    owner.beat()
    assert flight.verified == [owner.link]


def test_who_sends_back_what_it_was_sent_is_not_verified_by_it() -> None:
    """The heartbeats in the vehicle's name are signed with the clients' key, by the bridge."""
    flight = Door()
    flight.connected()
    mirror = flight.comes(246)
    flight.run(2.5)
    assert len(flight.bytes_to) >= 2
    for link, data in [*flight.bytes_to]:
        flight.feed(inputs.Datagram(link, data))
    assert not flight.verified
    assert {(item.link, item.reason) for item in flight.garbage()} == {(mirror.link, "replayed")}


def test_a_radios_own_message_verifies_nobody() -> None:
    """It is taken without a signature on other links, and is no sign of a key."""
    flight = Door()
    flight.connected()
    stranger = flight.comes(51)
    stranger.send(dialect.MAVLink_radio_status_message(1, 2, 3, 4, 5, 6, 7))
    flight.run(1.5)
    assert not flight.verified
    assert [(item.link, item.reason) for item in flight.garbage()] == [(stranger.link, "unsigned")]
    assert flight.of(ipc.BridgeStatus)[-1].clients[0].client == 0, "it is nobody's operator"


def test_what_came_before_the_signature_in_one_datagram_has_no_effect() -> None:
    flight = Door()
    flight.connected()
    owner, stranger = flight.comes(245, CLIENT_KEY), flight.comes(246)
    arm = dialect.MAVLink_command_long_message(1, 1, ARM, 0, 1, 0, 0, 0, 0, 0, 0)
    unsigned = arm.pack(stranger.mav)
    beat = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    owner.send_raw(bytes(unsigned) + bytes(beat.pack(owner.mav)))
    flight.run(1.0)
    assert flight.verified == [owner.link]
    assert not flight.decisions()


def test_the_audit_reproduces_who_was_verified_and_when(monkeypatch: pytest.MonkeyPatch) -> None:
    tape = Tape()
    monkeypatch.setattr(
        Flight, "new_recorder", lambda _flight: Recorder.without_file(tape, START_NS)
    )
    flight = Door()
    stranger, owner = flight.comes(246), flight.comes(245, CLIENT_KEY)
    impostor = flight.comes(247, OTHER)
    for client in (stranger, impostor):
        client.command(ARM, 1)
    owner.beat()
    flown(flight, owner)
    stranger.beat()
    flight.feed(inputs.ClientGone(stranger.link, "silent for 10 s"))
    came = [item for _, item in flight.records if isinstance(item, InputItem)]
    assert {item.kind for item in came} >= {"ClientCame", "ClientGone"}
    result = audit(tape.take(), tape.attachments, "test", "")
    assert result.good, (result.notes, result.first[:5])


def test_a_flood_is_told_to_a_client_and_to_no_stranger() -> None:
    flight = Door()
    flight.connected()
    stranger, owner = flight.comes(246), flight.comes(245, CLIENT_KEY)
    owner.beat()
    for second in range(7):
        for client in (stranger, owner):
            client.beat()
            flight.feed(inputs.ClientFlooded(client.link, 100 + second))
        flight.run(1.0)
    told = [text for text in owner.messages("STATUSTEXT") if "dropped" in text.text]
    assert [text.severity for text in told] == [dialect.MAV_SEVERITY_WARNING] * 2
    assert [text.get_srcSystem() for text in told] == [1, 1]
    assert "gate: 100 dropped: more than 500 messages/s" in owner.texts()
    assert "gate: 515 dropped: more than 500 messages/s" in owner.texts()
    assert flight.kinds(stranger) == {"HEARTBEAT"}
    rows = flight.of(ipc.BridgeStatus)[-1].clients
    assert [row.dropped for row in rows] == [721, 721]
