"""What the vehicle tells about itself when asked: version, modes, camera."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from vehicle_sim.autopilot.boot import BootStage
from vehicle_sim.autopilot.interface import ImageCaptured, Vehicle
from vehicle_sim.autopilot.modes import MODES, Personality, by_number
from vehicle_sim.services.events.metadata import Metadata
from vehicle_sim.services.profile import CAMERA_MESSAGES, STANDARD_MODES, Profile
from vehicle_sim.services.telemetry.odometry import MOTION, utm_global_position
from vehicle_sim.services.telemetry.remote_id import open_drone_id_location, open_drone_id_system
from vehicle_sim.services.telemetry.status import STATUS
from vehicle_sim.services.telemetry.telemetry import STATE
from vehicle_sim.services.units import boot_ms, degrees_e7, millimetres, usec
from vehicle_sim.wire import messages as m

BUILDERS: Final = {**STATE, **STATUS, **MOTION}
MISSION_ACTIVE: Final = 1  # MISSION_MODE
MISSION_SUSPENDED: Final = 2
MISSION_MODES: Final = frozenset({"AUTO.MISSION", "AUTO"})
IMAGES_KEPT: Final = 200
HAS_IMAGE_MODE: Final = 0x2 | 0x8  # CAMERA_CAP_FLAGS: captures images, in a mode for it
STORAGE_READY: Final = 2
AVAILABLE_MIB: Final = 30_000.0

AWAITED: Final[dict[Personality, dict[int, Callable[[BootStage], bool]]]] = {
    "px4": {
        m.IDS[kind]: lambda stage: stage.attitude
        for kind in (m.Attitude, m.AttitudeQuaternion, m.GlobalPositionInt, m.UtmGlobalPosition)
    },
    "ardupilot": {
        m.IDS[m.LocalPositionNed]: lambda stage: stage.position,
        m.IDS[m.ExtendedSysState]: lambda stage: stage.initialised,
    },
}
"""What is not sent before the vehicle has started up so far, as recorded (`autopilot/boot.py`)."""


class Info:
    """Builds every message that can be streamed or asked for."""

    def __init__(
        self,
        vehicle: Vehicle,
        profile: Profile,
        system: int,
        unix_start_ns: int,
        plan_ids: Callable[[], tuple[int, int, int, int]],
        metadata: Metadata | None = None,
        event_sequence: Callable[[], m.CurrentEventSequence] | None = None,
        control_status: Callable[[], m.ControlStatus] | None = None,
    ) -> None:
        """`plan_ids`: number of mission items, then the ids of mission, fence and rally points;
        `event_sequence`: of a vehicle that has the events interface; `control_status`: of one that
        one station at a time commands."""
        self._vehicle = vehicle
        self._profile = profile
        self._modes = tuple(MODES[profile.name].values())
        self._awaited = AWAITED[profile.name]
        self.system = system
        self._unix_start_ns = unix_start_ns
        self._plan_ids = plan_ids
        self._metadata = metadata
        self._images: list[m.CameraImageCaptured] = []
        self._pings = 0
        self._own: Final[dict[int, Callable[[], m.Message | None]]] = {
            m.IDS[m.SystemTime]: self._system_time,
            m.IDS[m.Timesync]: self._timesync,
            m.IDS[m.Ping]: self._ping,
            m.IDS[m.UtmGlobalPosition]: self._utm_global_position,
            m.IDS[m.OpenDroneIdLocation]: self._open_drone_id_location,
            m.IDS[m.OpenDroneIdSystem]: self._open_drone_id_system,
            m.IDS[m.MissionCurrent]: self.mission_current,
            m.IDS[m.CurrentMode]: self._current_mode,
            m.IDS[m.AvailableModesMonitor]: self._available_modes_monitor,
            m.IDS[m.AutopilotVersion]: self._autopilot_version,
            m.IDS[m.ProtocolVersion]: self._protocol_version,
            m.IDS[m.CameraInformation]: self._camera_information,
            m.IDS[m.CameraSettings]: self._camera_settings,
            m.IDS[m.CameraCaptureStatus]: self._camera_capture_status,
            m.IDS[m.StorageInformation]: self._storage_information,
        }
        if event_sequence is not None:
            self._own[m.IDS[m.CurrentEventSequence]] = event_sequence
        if control_status is not None:
            self._own[m.IDS[m.ControlStatus]] = control_status
        missing = frozenset[int]() if profile.camera else CAMERA_MESSAGES[profile.name]
        missing |= {m.IDS[kind] for kind in profile.unsent_messages}
        self.streamable: Final = (frozenset(BUILDERS) | frozenset(self._own)) - missing

    def build(self, number: int) -> m.Message | None:
        """None: there is no such message, or nothing true to say yet."""
        awaited = self._awaited.get(number)
        if awaited is not None and not awaited(self._vehicle.boot_stage):
            return None
        builder = BUILDERS.get(number)
        if builder is not None:
            return builder(self._vehicle, self._profile)
        own = self._own.get(number)
        return own() if own is not None else None

    def answers(self, number: int) -> bool:
        """REQUEST_MESSAGE for it is understood."""
        if number == m.IDS[m.ComponentMetadata]:
            return self._metadata is not None
        return number in self.streamable or number in (
            m.IDS[m.AvailableModes],
            m.IDS[m.CameraImageCaptured],
        )

    def requested(self, number: int, index: float) -> list[m.Message]:
        """What REQUEST_MESSAGE with that second parameter is answered with."""
        if number == m.IDS[m.AvailableModes]:
            return self._available_modes(index)
        if number == m.IDS[m.CameraImageCaptured]:
            return [image for image in self._images if image.image_index == index]
        if number == m.IDS[m.ComponentMetadata] and self._metadata is not None:
            return [self._component_metadata(self._metadata)]
        built = self.build(number)
        return [built] if built is not None else []

    def captured(self, event: ImageCaptured) -> list[m.Message]:
        """An image was taken: what is sent unasked."""
        w, x, y, z = event.q_ned_from_frd
        where = event.geodetic
        latitude, longitude = degrees_e7(where.lat_deg), degrees_e7(where.lon_deg)
        image = m.CameraImageCaptured(
            time_utc=(self._unix_start_ns + event.time_ns) // 1000,
            time_boot_ms=event.time_ns // 1_000_000 & 0xFFFFFFFF,
            lat=latitude,
            lon=longitude,
            alt=millimetres(where.alt_amsl_m),
            relative_alt=millimetres(event.alt_rel_m),
            q=(w, x, y, z),
            image_index=event.index,
            camera_id=0,
            capture_result=1,
            file_url=b"",
        )
        self._images = [*self._images[-IMAGES_KEPT + 1 :], image]
        if not self._profile.camera_feedback:
            return [image]
        feedback = m.CameraFeedback(
            time_usec=event.time_ns // 1000,
            lat=latitude,
            lng=longitude,
            alt_msl=where.alt_amsl_m,
            alt_rel=event.alt_rel_m,
            roll=0.0,
            pitch=0.0,
            yaw=0.0,
            foc_len=0.0,
            img_idx=event.index & 0xFFFF,
            target_system=self.system,
            cam_idx=0,
            flags=0,
        )
        return [image, feedback]

    def _system_time(self) -> m.Message:
        return m.SystemTime(
            time_unix_usec=self._unix_start_ns // 1000 + usec(self._vehicle),
            time_boot_ms=boot_ms(self._vehicle),
        )

    def _timesync(self) -> m.Message:
        """A request: what it is answered with is not used here."""
        return m.Timesync(tc1=0, ts1=self._vehicle.clock_ns)

    def _ping(self) -> m.Message:
        """A request, to everybody."""
        sequence = self._pings
        self._pings += 1
        return m.Ping(usec(self._vehicle), sequence, 0, 0)

    def _utm_global_position(self) -> m.Message | None:
        return utm_global_position(self._vehicle, self._unix_start_ns)

    def _open_drone_id_location(self) -> m.Message | None:
        return open_drone_id_location(self._vehicle)

    def _open_drone_id_system(self) -> m.Message | None:
        return open_drone_id_system(self._vehicle, self._unix_start_ns)

    def mission_current(self) -> m.Message | None:
        """A PX4 1.14 tells the item alone, and without a mission nothing."""
        if not self._profile.tells_mission_whole:
            seq = self._vehicle.mission_current
            return m.MissionCurrent(seq, 0, 0, 0, 0, 0, 0) if self._vehicle.plan else None
        total, mission_id, fence_id, rally_id = self._plan_ids()
        return m.MissionCurrent(
            seq=self._vehicle.mission_current,
            total=total,
            mission_state=self._vehicle.mission_state,
            mission_mode=(MISSION_ACTIVE if self.mode_name in MISSION_MODES else MISSION_SUSPENDED),
            mission_id=mission_id,
            fence_id=fence_id,
            rally_points_id=rally_id,
        )

    @property
    def mode_name(self) -> str:
        """The autopilot's own name for the present mode."""
        mode = by_number(self._profile.name, self._vehicle.custom_mode)
        return mode.name if mode is not None else str(self._vehicle.custom_mode)

    def _current_mode(self) -> m.Message:
        custom_mode = self._vehicle.custom_mode
        return m.CurrentMode(
            custom_mode=custom_mode,
            intended_custom_mode=custom_mode,
            standard_mode=STANDARD_MODES.get(self.mode_name, 0),
        )

    def _available_modes_monitor(self) -> m.Message:
        """The modes never change."""
        return m.AvailableModesMonitor(seq=0)

    def _available_modes(self, index: float) -> list[m.Message]:
        """Index 0 = all of them; they count from 1."""
        return [
            m.AvailableModes(
                custom_mode=mode.custom_mode,
                properties=mode.properties,
                number_modes=len(self._modes),
                mode_index=number,
                standard_mode=STANDARD_MODES.get(mode.name, 0),
                mode_name=mode.name.encode("ascii"),
            )
            for number, mode in enumerate(self._modes, start=1)
            if index in (0, number)
        ]

    def _autopilot_version(self) -> m.Message:
        return m.AutopilotVersion(
            capabilities=self._profile.capabilities,
            uid=0x6D61_7667_0000_0000 + self.system,
            flight_sw_version=self._profile.flight_sw_version,
            middleware_sw_version=0,
            os_sw_version=0,
            board_version=0,
            vendor_id=0,
            product_id=0,
            flight_custom_version=b"",
            middleware_custom_version=b"",
            os_custom_version=b"",
        )

    def _component_metadata(self, metadata: Metadata) -> m.Message:
        """Only on request, as PX4 does."""
        return m.ComponentMetadata(
            boot_ms(self._vehicle), metadata.crc, metadata.uri.encode("ascii")
        )

    def _protocol_version(self) -> m.Message:
        return m.ProtocolVersion(200, 100, 200, b"", b"")

    def _camera_information(self) -> m.Message:
        return m.CameraInformation(
            time_boot_ms=boot_ms(self._vehicle),
            firmware_version=0x01000001,
            focal_length=4.5,
            sensor_size_h=6.2,
            sensor_size_v=4.65,
            flags=HAS_IMAGE_MODE,
            resolution_h=4000,
            resolution_v=3000,
            cam_definition_version=0,
            vendor_name=b"vehicle-sim",
            model_name=b"still",
            lens_id=0,
            cam_definition_uri=b"",
            camera_device_id=1,
        )

    def _camera_settings(self) -> m.Message:
        return m.CameraSettings(boot_ms(self._vehicle), mode_id=0)

    def _camera_capture_status(self) -> m.Message:
        return m.CameraCaptureStatus(
            time_boot_ms=boot_ms(self._vehicle),
            image_interval=0.0,
            recording_time_ms=0,
            available_capacity=AVAILABLE_MIB,
            image_status=1 if self._vehicle.capturing else 0,
            video_status=0,
            image_count=self._vehicle.images_captured,
        )

    def _storage_information(self) -> m.Message:
        return m.StorageInformation(
            time_boot_ms=boot_ms(self._vehicle),
            total_capacity=AVAILABLE_MIB,
            used_capacity=0.0,
            available_capacity=AVAILABLE_MIB,
            read_speed=0.0,
            write_speed=0.0,
            storage_id=1,
            storage_count=1,
            status=STORAGE_READY,
        )
