"""The guard of one vehicle's set-up: what a client may change of it, by the policy's `[bridge]`.

Given is only what the bridge's tables class as configuration; what has no row here is refused.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.plans.results import result_of
from gcs.bridge.setup_policy.commands import ROWS, choice_of, storage_keeps
from gcs.bridge.setup_policy.files import is_read, judge_file
from gcs.bridge.setup_policy.parameters import HASH_CHECK, Changed, ParameterGuard, refused_write
from gcs.bridge.setup_policy.parameters import KEY as PARAMETERS_KEY
from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Judgement, Refused, by_choice
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import PX4, ParamEncoding
from gcs.wire.ids import MissionType, ParamFault
from gcs.wire.messages import (
    CommandInt,
    CommandLong,
    FencePoint,
    FileTransferProtocol,
    GpsRtcmData,
    LogRequestData,
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionWritePartialList,
    ParamExtSet,
    ParamSet,
    ParamValue,
    RallyPoint,
    RemoteLogBlockStatus,
    SetGpsGlobalOrigin,
    SetHomePosition,
    SetupSigning,
)

_PLANS: Final = {
    MissionType.FENCE: (("fence", "the vehicle's own fence"),),
    MissionType.RALLY: (("rally", "the vehicle's rally points"),),
    MissionType.ALL: (
        ("fence", "the vehicle's own fence"),
        ("rally", "the vehicle's rally points"),
    ),
}
"""Keys of the policy that a transfer of that type stands under."""


FOR_ALL: Final = (
    GpsRtcmData,
    LogRequestData,
    RemoteLogBlockStatus,
    MissionCount,
    MissionClearAll,
    MissionWritePartialList,
)


class Guard:
    """Judges what would change the vehicle's set-up; has no clock."""

    def __init__(self, rules: BridgeRules, autopilot_name: str) -> None:
        encoding = PX4.param_encoding if autopilot_name == PX4.name else ParamEncoding.CAST
        self._rules = rules
        self._parameters = ParameterGuard(rules, autopilot_name, encoding)

    def judge(self, message: Message, seen: GuardSeen) -> Judgement:
        """Whether `message` of a client may go to the vehicle."""
        judged = self._by_policy(message, seen)
        if isinstance(judged, Refused) or seen.in_control or _is_for_all(message):
            return judged
        refusal = Refusal(Code.OTHER_OPERATOR, "another client is in control, and sets up")
        if isinstance(message, ParamSet):
            return refused_write(message, seen, refusal, ParamFault.PERMISSION_DENIED)
        return Refused(refusal)

    def _by_policy(self, message: Message, seen: GuardSeen) -> Judgement:
        rules = self._rules
        match message:
            case ParamSet():
                return self._parameters.judge(message, seen)
            case ParamExtSet():
                return self._parameters.judge_extended(message, seen)
            case FileTransferProtocol():
                return judge_file(message, rules, seen)
            case CommandLong() | CommandInt():
                return self._command(message, seen)
            case SetHomePosition():
                return by_choice(rules.home, "home", "moving home", seen)
            case SetGpsGlobalOrigin():
                what = "moving the origin of the local frame"
                return by_choice(rules.origin, "origin", what, seen)
            case SetupSigning():
                what = "giving the vehicle another key"
                return by_choice(rules.signing, "signing", what, seen)
            case FencePoint():
                return by_choice(rules.fence, "fence", "changing the vehicle's own fence", seen)
            case RallyPoint():
                return by_choice(rules.rally, "rally", "changing the vehicle's rally points", seen)
            case GpsRtcmData():
                judged = by_choice(rules.rtcm, "rtcm", "corrections for the GPS receiver", seen)
                return Allowed() if isinstance(judged, Allowed) else judged
            case LogRequestData() | RemoteLogBlockStatus():
                judged = by_choice(rules.downloads, "downloads", "reading a log", seen)
                return Allowed() if isinstance(judged, Allowed) else judged
            case MissionCount() | MissionClearAll() | MissionWritePartialList():
                return self._plan(message, seen)
            case _:
                sentence = f"{type(message).__name__} has no rule here"
                return Refused(Refusal(Code.UNSUPPORTED, sentence))

    def awaits(self, name: str) -> bool:
        """A client has written the parameter, and the vehicle has not told its value since."""
        return self._parameters.awaits(name)

    def written_by_station(self, message: ParamSet, now_ns: int) -> None:
        """The station sends a PARAM_SET of its own."""
        self._parameters.written_by_station(message, now_ns)

    def heard(self, message: ParamValue, now_ns: int) -> Changed | None:
        """PARAM_VALUE of the vehicle's autopilot: the news in it, for the log."""
        return self._parameters.heard(message, now_ns)

    def _command(self, message: CommandLong | CommandInt, seen: GuardSeen) -> Judgement:
        row = ROWS.get(message.command)
        if row is None:
            sentence = f"command {message.command} has no rule here"
            return Refused(Refusal(Code.UNSUPPORTED, sentence))
        if row.key is None:
            return Refused(Refusal(Code.POLICY, f"{row.what} is never allowed to a client"))
        if row.key == "parameters":
            return self._storage(message, row.what, seen)
        return by_choice(choice_of(row.key, self._rules), row.key, row.what, seen)

    def _storage(self, message: CommandLong | CommandInt, what: str, seen: GuardSeen) -> Judgement:
        """PREFLIGHT_STORAGE."""
        if storage_keeps(message):
            return Allowed()
        if self._rules.parameters != "forward":
            return Refused(Refusal(Code.POLICY, f"{what} is not allowed ({PARAMETERS_KEY})"))
        return by_choice("on_ground", "parameters", what, seen)

    def _plan(
        self, message: MissionCount | MissionClearAll | MissionWritePartialList, seen: GuardSeen
    ) -> Judgement:
        """Fences and rally points; a mission itself is not the guard's."""
        keys = _PLANS.get(MissionType(message.mission_type)) if _known(message) else ()
        if isinstance(message, MissionCount) and message.mission_type == MissionType.ALL:
            keys = ()  # all at once are cleared, and not sent
        if keys is None:
            return Allowed()
        if not keys:
            sentence = f"plans of type {message.mission_type} are not known here"
            return _plan_refused(message, seen, Refusal(Code.UNSUPPORTED, sentence))
        for key, whose in keys:
            choice = self._rules.fence if key == "fence" else self._rules.rally
            judged = by_choice(choice, key, f"changing {whose}", seen)
            if isinstance(judged, Refused):
                return _plan_refused(message, seen, judged.refusal)
        return Allowed(f"changing {' and '.join(whose for _, whose in keys)} is forwarded")


def _is_for_all(message: Message) -> bool:
    """It changes nothing, or (a plan) the station says later who may: of any client."""
    match message:
        case ParamSet(param_id=name):
            return name == HASH_CHECK
        case FileTransferProtocol(payload=payload):
            return is_read(payload)
        case CommandLong() | CommandInt():
            key = ROWS[message.command].key
            keeps = key == "parameters" and storage_keeps(message)
            return keeps or key == "downloads"
        case _:
            return isinstance(message, FOR_ALL)


def _known(message: MissionCount | MissionClearAll | MissionWritePartialList) -> bool:
    return message.mission_type in frozenset(int(kind) for kind in MissionType)


def _plan_refused(
    message: MissionCount | MissionClearAll | MissionWritePartialList,
    seen: GuardSeen,
    refusal: Refusal,
) -> Refused:
    answer = MissionAck(
        target_system=seen.client.sysid,
        target_component=seen.client.compid,
        type=result_of(refusal.code, refusal.sentence),
        mission_type=message.mission_type,
    )
    return Refused(refusal, (answer,))
