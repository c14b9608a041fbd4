"""Made by `python -m tests.unit.async_stub`: the types of `async_station.py`."""

from collections.abc import AsyncIterator, Generator, Mapping, Sequence

from gcs import ipc
from gcs.frames import Vec3
from gcs.operator.conversation import Found
from gcs.operator.requests.missions import Path

class AsyncOperation:
    @property
    def asked(self) -> ipc.Ask: ...
    @property
    def id(self) -> int: ...
    @property
    def state(self) -> str: ...
    @property
    def ending(self) -> ipc.EndingEvent | None: ...
    @property
    def found(self) -> list[Found]: ...
    @property
    def goal_enu(self) -> ipc.Maybe3 | None: ...
    @property
    def numbers(self) -> dict[str, float | None]: ...
    @property
    def picture(self) -> int | None: ...
    async def wait(self, timeout_s: float | None = None) -> AsyncOperation: ...
    async def stop(self) -> None: ...

class AsyncStream:
    async def __aenter__(self) -> AsyncStream: ...
    async def __aexit__(self, *_: object) -> None: ...
    @property
    def refusal(self) -> ipc.StreamVerdictEvent | None: ...
    async def velocity(
        self,
        east_m_s: float,
        north_m_s: float,
        up_m_s: float,
        *,
        yaw_deg: float | None = None,
        yaw_rate_deg_s: float | None = None,
    ) -> None: ...
    async def position(
        self, east_m: float, north_m: float, up_m: float, *, yaw_deg: float | None = None
    ) -> None: ...
    async def attitude(
        self,
        roll_deg: float,
        pitch_deg: float,
        yaw_deg: float,
        thrust: float,
        *,
        yaw_rate_deg_s: float | None = None,
    ) -> None: ...
    async def send(self, sample: ipc.Stream) -> None: ...
    async def check(self) -> None: ...
    def ticks(self, seconds: float = ..., period_s: float = ...) -> AsyncIterator[float]: ...

class AsyncStation:
    async def __aenter__(self) -> AsyncStation: ...
    async def __aexit__(self, *_: object) -> None: ...
    async def close(self) -> None: ...
    def stream(self) -> AsyncStream: ...
    async def velocity(
        self,
        east_m_s: float,
        north_m_s: float,
        up_m_s: float,
        yaw_rate_deg_s: float | None = None,
        *,
        seconds: float,
    ) -> None: ...
    @property
    def snapshot(self) -> ipc.Snapshot: ...
    @property
    def state(self) -> str: ...
    @property
    def position_enu(self) -> Vec3 | None: ...
    @property
    def armed(self) -> bool | None: ...
    @property
    def log_path(self) -> str: ...
    @property
    def in_control(self) -> bool: ...
    async def telemetry(self, message: str, timeout_s: float = ...) -> Mapping[str, object]: ...
    def events(self) -> AsyncIterator[ipc.Event]: ...
    async def request(
        self, ask: ipc.Ask, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def check(self, request: ipc.Ask, timeout_s: float = ...) -> ipc.Checked: ...
    async def check_goto(
        self, east_m: float, north_m: float, up_m: float, yaw_deg: float | None = None
    ) -> ipc.Checked: ...
    async def control(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def arm(self, *, wait: bool = True, timeout_s: float | None = None) -> AsyncOperation: ...
    async def disarm(
        self, *, force: bool = False, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def takeoff(
        self, up_m: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def goto(
        self,
        east_m: float,
        north_m: float,
        up_m: float,
        yaw_deg: float | None = None,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> AsyncOperation: ...
    async def goto_global(
        self,
        lat_deg: float,
        lon_deg: float,
        up_m: float,
        yaw_deg: float | None = None,
        *,
        amsl: bool = False,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> AsyncOperation: ...
    async def move(
        self,
        east_m: float = 0.0,
        north_m: float = 0.0,
        up_m: float = 0.0,
        yaw_deg: float | None = None,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> AsyncOperation: ...
    async def forward(
        self,
        forward_m: float,
        right_m: float = 0.0,
        up_m: float = 0.0,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> AsyncOperation: ...
    async def heading(
        self, yaw_deg: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def orbit(
        self,
        radius_m: float,
        speed_m_s: float,
        centre: tuple[float, float, float] | None = None,
        *,
        turns: float = 0.0,
        nose: str = "centre",
        wait: bool | None = None,
        timeout_s: float | None = None,
    ) -> AsyncOperation: ...
    async def land(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def rtl(self, *, wait: bool = True, timeout_s: float | None = None) -> AsyncOperation: ...
    async def hold(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def abort(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def resume(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def photo(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def mode(
        self, mode_name: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def take_control(self) -> None: ...
    async def fly(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def upload(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def download(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def clear_mission(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def put_fence(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def upload_fence(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def download_fence(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def clear_fence(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def upload_rally(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def download_rally(
        self, path: Path, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def clear_rally(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def start_mission(
        self, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...
    async def parameters(self, timeout_s: float | None = None) -> dict[str, int | float]: ...
    async def parameter(self, name: str, timeout_s: float | None = None) -> int | float: ...
    async def set_parameter(
        self, name: str, value: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> AsyncOperation: ...

class Connecting:
    def __await__(self) -> Generator[object, None, AsyncStation]: ...
    async def __aenter__(self) -> AsyncStation: ...
    async def __aexit__(self, *_: object) -> None: ...

def aconnect(
    link: str | Sequence[str] | None = None,
    *,
    sim: bool = False,
    policy: str | None = None,
    sign_key: str | None = None,
    take_control: bool = False,
    keep: bool | None = None,
    autopilot: str | None = None,
    vehicle: int | None = None,
    speedup: float | None = None,
    log_dir: str | None = None,
    name: str = "script",
    timeout_s: float = 10.0,
) -> Connecting: ...
