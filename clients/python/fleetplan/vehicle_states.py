"""What a vehicle of VDA 5050 says of itself: which of it is read, and whether it can be."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fleetplan.errors import InvalidValue, shown
from fleetplan.http import read_json
from fleetplan.types import VdaMessage

_MAX_ID = 4294967294  # what the service reads of numbers of orders and nodes
_FARTHEST = 1e9  # metres
_MAX_BYTES = 1 << 20  # of a message
_MAX_ITEMS = 10000  # of a list
_LONGEST = 1024  # characters of a name

_NAMES = ("orderId", "lastNodeId", "nodeId", "edgeId", "actionId", "actionStatus", "actionType", "errorLevel", "mapId",
          "operatingMode", "eStop", "activeEmergencyStop", "serialNumber", "manufacturer")
_WORDS = ("errorType", "referenceKey", "referenceValue", "version", "timestamp")  # left out if they are no text
_NUMBERS = ("x", "y", "theta")
_IDS = ("orderUpdateId", "lastNodeSequenceId", "sequenceId", "headerId")
_FLAGS = ("positionInitialized", "localized", "released", "paused", "driving", "newBaseRequest", "fieldViolation")
_LISTS = ("nodeStates", "edgeStates", "actionStates", "instantActionStates", "errors", "errorReferences")
_OBJECTS = ("agvPosition", "mobileRobotPosition", "safetyState")
_REQUIRED = {"": ("orderId", "orderUpdateId"), "nodeStates": ("sequenceId",),
             "actionStates": ("actionId", "actionStatus"), "instantActionStates": ("actionId", "actionStatus"),
             "errors": ("errorLevel",), "agvPosition": _NUMBERS, "mobileRobotPosition": _NUMBERS}


class SentState(VdaMessage):
    """A state message, and its sender by its topic, because a broker can restrict topics for vehicles."""

    def __init__(self, state: VdaMessage, manufacturer: str, serial_number: str) -> None:
        super().__init__(state)
        self.sender = {"manufacturer": manufacturer, "serialNumber": serial_number}


def state_on(topic: str, payload: bytes) -> SentState:
    """The state that came on a topic. Raises InvalidValue if it is no state, or says that another vehicle has sent it."""
    if len(payload) > _MAX_BYTES:
        raise InvalidValue(f"a message of {len(payload)} bytes is too long")
    state, levels = read_json(payload), topic.split("/")
    if not isinstance(state, dict):
        raise InvalidValue(f"{shown(payload[:80])} is no JSON object")
    if len(levels) < 3:
        raise InvalidValue("the topic is of no vehicle")
    sent = SentState(state, levels[-3], levels[-2])
    for name, of_topic in sent.sender.items():
        if state.get(name) not in (None, of_topic):
            raise InvalidValue(f"the {name} is {shown(state[name])}, which may not publish here")
    return sent


def read_state(message: object) -> VdaMessage:
    """What is read of a state message, of 2.0 to 3.0. Optional members may be null, which is as if they were not there.
    Raises InvalidValue if one cannot be read."""
    if not isinstance(message, Mapping):
        raise InvalidValue("is no object")
    try:
        read = _object(message, "")
    except RecursionError:
        raise InvalidValue("is nested too deeply") from None
    return {**read, **message.sender} if isinstance(message, SentState) else read


def sender_of(state: object) -> str:
    """For messages: the make and the number."""
    names = [state.get(name) if isinstance(state, Mapping) else None for name in ("manufacturer", "serialNumber")]
    return "/".join(name if isinstance(name, str) else "?" for name in names)


def _object(message: Mapping[Any, object], of: str) -> VdaMessage:
    read: VdaMessage = {}
    for name, value in message.items():
        if name in _WORDS and _is_text(value):
            read[name] = value
        elif name in _KINDS and value is not None:
            read[name] = _KINDS[name](name, value)
    for name in _REQUIRED.get(of, ()):
        if name not in read:
            raise InvalidValue(f"has no {name}")
    return read


def _is_text(value: object) -> bool:
    """Without lone surrogates, which UTF-8 does not have."""
    return isinstance(value, str) and len(value) <= _LONGEST and not any("\ud800" <= letter <= "\udfff" for letter in value)


def _name(name: str, value: object) -> object:
    if not _is_text(value):
        raise InvalidValue(f"has the {name} {shown(value)}")
    return value


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not -_FARTHEST <= value <= _FARTHEST:
        raise InvalidValue(f"has the {name} {shown(value)}")
    return value


def _id(name: str, value: object) -> int:
    if isinstance(value, float) and math.isfinite(value) and value.is_integer():
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MAX_ID:
        raise InvalidValue(f"has the {name} {shown(value)}")
    return value


def _flag(name: str, value: object) -> bool:
    if not isinstance(value, bool):
        raise InvalidValue(f"has the {name} {shown(value)}")
    return value


def _list(name: str, value: object) -> list[VdaMessage]:
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) > _MAX_ITEMS:
        raise InvalidValue(f"has {name} that are no list, or too long a one")
    return [_inside(name, item) for item in value]


def _inside(name: str, value: object) -> VdaMessage:
    if not isinstance(value, Mapping):
        raise InvalidValue(f"has the {name} {shown(value)}")
    return _object(value, name)


_KINDS: dict[str, Callable[[str, object], object]] = {
    **dict.fromkeys(_NAMES, _name), **dict.fromkeys(_NUMBERS, _number), **dict.fromkeys(_IDS, _id),
    **dict.fromkeys(_FLAGS, _flag), **dict.fromkeys(_LISTS, _list), **dict.fromkeys(_OBJECTS, _inside)}
