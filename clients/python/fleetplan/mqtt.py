"""Messages of VDA 5050 over MQTT. It needs paho-mqtt: `pip install fleetplan[mqtt]`, or Debian's python3-paho-mqtt."""

import datetime
import importlib
import time
from collections.abc import Callable, Collection, Iterable
from types import TracebackType
from typing import Any

from fleetplan.errors import ConnectionFailed, InvalidValue, MessageRejected, RequestRefused, shown
from fleetplan.faults import Faults, OnFault
from fleetplan.http import write_json
from fleetplan.types import VdaMessage
from fleetplan.vda5050 import Message, VdaLoop
from fleetplan.vehicle_states import state_on

_paho: Any = importlib.import_module("paho.mqtt.client")  # its types depend on the version
_CONNECT = 10.0  # seconds: for which `start` waits for the broker


class MqttTransport:
    """Publishes messages for vehicles, and calls `take` with their state messages, in a separate thread.

    The topic tells which vehicle sends a message, because a broker can restrict topics for vehicles. A message that
    contradicts its topic, or that is not JSON, is ignored.
    """

    def __init__(self, take: Callable[[VdaMessage], None], *, manufacturer: str | Collection[str],
                 version: str = "2.1.0", host: str = "localhost", port: int = 1883, interface: str = "uagv",
                 username: str | None = None, password: str | None = None, tls: bool = False,
                 on_fault: OnFault | None = None) -> None:
        """`manufacturer`: of one vehicle, or of all vehicles of the fleet. `interface`: the first level of the topics;
        the version's major number is the second level. `on_fault` is called with each message that is not used, in the
        thread of the transport. Faults are logged, too."""
        self._take, self._version, self._faults = take, version, Faults(on_fault)
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
        self._client.on_message = lambda _client, _data, message: self._receive(message)

    def __enter__(self) -> "MqttTransport":
        self.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.stop()

    def start(self) -> None:
        """Connects. A connection that is lost later is made again."""
        try:
            self._client.connect(*self._address)
        except (OSError, ValueError) as error:
            raise ConnectionFailed(f"no connection to the broker at {self._address}: {error}") from error
        self._client.loop_start()
        give_up = time.monotonic() + _CONNECT
        while not self._client.is_connected():
            if time.monotonic() > give_up:
                self.stop()
                raise ConnectionFailed(f"no connection to the broker at {self._address}")
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
            self._client.publish(topic, write_json(body), qos=0)

    def _receive(self, message: Any) -> None:
        """Whatever a message contains, the thread goes on to the next message."""
        topic = "a topic"
        try:
            topic = str(message.topic)
            self._take(state_on(topic, message.payload))
        except InvalidValue as error:
            self._faults.tell(MessageRejected(topic, str(error)))
        except Exception as error:  # of `take`
            self._faults.tell(MessageRejected(topic, f"{type(error).__name__}: {shown(str(error))}"))


def run(loop: VdaLoop, transport: MqttTransport, until: Callable[[], bool] = lambda: False, pause: float = 0.1) -> None:
    """Steps the loop, and sends its messages, until told otherwise. Goals that are refused, which the loop has told, cost
    nothing but these goals."""
    while not until():
        try:
            transport.send(loop.step())
        except RequestRefused as error:
            if not error.robots:  # the first request is at fault
                raise
        time.sleep(pause)
