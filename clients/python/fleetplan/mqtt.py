"""Messages of VDA 5050 over MQTT. It needs paho-mqtt: `pip install fleetplan[mqtt]`, or Debian's python3-paho-mqtt."""

import datetime
import importlib
import json
import time
from collections.abc import Callable, Collection, Iterable
from types import TracebackType
from typing import Any

from fleetplan.types import VdaMessage
from fleetplan.vda5050 import Message, VdaLoop

_paho: Any = importlib.import_module("paho.mqtt.client")  # its types depend on the version
_CONNECT = 10.0  # seconds: for which `start` waits for the broker


class MqttTransport:
    """Publishes messages for vehicles, and calls `take` with their state messages, in a thread of its own."""

    def __init__(self, take: Callable[[VdaMessage], None], *, manufacturer: str | Collection[str],
                 version: str = "2.1.0", host: str = "localhost", port: int = 1883, interface: str = "uagv",
                 username: str | None = None, password: str | None = None, tls: bool = False) -> None:
        """`manufacturer`: or all of those of the fleet. `interface`: the first level of the topics; the version's major
        number is the second one."""
        self._take, self._version = take, version
        makes = {manufacturer} if isinstance(manufacturer, str) else set(manufacturer)
        self._address, self._root = (host, port), f"{interface}/v{version.split('.')[0]}"
        self._headers: dict[str, int] = {}  # the next headerId of each topic
        versions = getattr(_paho, "CallbackAPIVersion", None)  # from 2.0 of paho-mqtt on
        self._client = _paho.Client() if versions is None else _paho.Client(versions.VERSION2)
        if username is not None:
            self._client.username_pw_set(username, password)
        if tls:
            self._client.tls_set()
        topics = [(f"{self._root}/{make}/+/state", 0) for make in sorted(makes)]
        self._client.on_connect = lambda client, *_: client.subscribe(topics)
        self._client.on_message = lambda _client, _data, message: self._receive(message.payload)

    def __enter__(self) -> "MqttTransport":
        self.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.stop()

    def start(self) -> None:
        """Connects. A connection that is lost later is made again."""
        self._client.connect(*self._address)
        self._client.loop_start()
        give_up = time.monotonic() + _CONNECT
        while not self._client.is_connected():
            if time.monotonic() > give_up:
                raise TimeoutError(f"no connection to the broker at {self._address}")
            time.sleep(0.01)

    def stop(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def send(self, messages: Iterable[Message]) -> None:
        for message in messages:
            topic = f"{self._root}/{message.manufacturer}/{message.serial_number}/{message.topic}"
            header = self._headers.get(topic, 0)
            self._headers[topic] = header + 1
            now = datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
            body = {"headerId": header, "timestamp": now, "version": self._version,
                    "manufacturer": message.manufacturer, "serialNumber": message.serial_number, **message.body}
            self._client.publish(topic, json.dumps(body, separators=(",", ":")), qos=0)

    def _receive(self, payload: bytes) -> None:
        try:
            state = json.loads(payload)
        except ValueError:
            return  # not from a vehicle that speaks VDA 5050
        if isinstance(state, dict):
            self._take(state)


def run(loop: VdaLoop, transport: MqttTransport, until: Callable[[], bool] = lambda: False, pause: float = 0.1) -> None:
    """Steps the loop, and sends its messages, until told otherwise."""
    while not until():
        transport.send(loop.step())
        time.sleep(pause)
