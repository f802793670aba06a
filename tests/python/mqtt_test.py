"""Messages of VDA 5050 over MQTT, with Debian's mosquitto as the broker."""

import contextlib
import json
import os
import pathlib
import queue
import socket
import subprocess
import tempfile
import time
import unittest

import support  # noqa: F401: the package's path
from paho.mqtt import client as paho

from fleetplan.mqtt import MqttTransport, run
from fleetplan.vda5050 import Message


@contextlib.contextmanager
def broker():
    """The port of a broker."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        settings = pathlib.Path(folder) / "mosquitto.conf"
        settings.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\npersistence false\n")
        process = subprocess.Popen(["mosquitto", "-c", str(settings)], stderr=subprocess.DEVNULL,
                                   env={**os.environ, "PATH": f"{os.environ['PATH']}:/usr/sbin"})
        try:
            give_up = time.monotonic() + 20.0
            while time.monotonic() < give_up:
                with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 0.1):
                    break
                time.sleep(0.05)
            yield port
        finally:
            process.terminate()
            process.wait()


class Loop:
    """What is stepped, once."""

    def step(self):
        return [Message("order", "acme", "0815", {"orderId": "o"}), Message("order", "acme", "0815", {"orderId": "p"})]


class Mqtt(unittest.TestCase):
    def test_states_arrive_and_orders_are_sent(self):
        states, received = queue.Queue(), queue.Queue()
        with broker() as port, MqttTransport(states.put, manufacturer=["acme", "bolt"], host="127.0.0.1", port=port) as transport:
            versions = getattr(paho, "CallbackAPIVersion", None)  # from 2.0 of paho-mqtt on
            vehicle = paho.Client() if versions is None else paho.Client(versions.VERSION2)
            vehicle.on_message = lambda _client, _data, message: received.put((message.topic, json.loads(message.payload)))
            vehicle.connect("127.0.0.1", port)
            vehicle.subscribe("uagv/v2/acme/0815/order")
            vehicle.loop_start()
            state = None
            while state is None:  # whoever subscribes first
                vehicle.publish("uagv/v2/acme/0815/state", "not JSON")
                vehicle.publish("uagv/v2/acme/0815/state", json.dumps({"serialNumber": "0815"}))
                with contextlib.suppress(queue.Empty):
                    state = states.get(timeout=0.2)
            rounds = iter([False, True])
            run(Loop(), transport, until=lambda: next(rounds), pause=0.0)
            sent = [received.get(timeout=10.0) for _ in range(2)]
            vehicle.disconnect()
            vehicle.loop_stop()
        self.assertEqual(state, {"serialNumber": "0815"})
        self.assertEqual([topic for topic, _ in sent], ["uagv/v2/acme/0815/order"] * 2)
        self.assertEqual([(body["headerId"], body["orderId"]) for _, body in sent], [(0, "o"), (1, "p")])
        self.assertEqual((sent[0][1]["version"], sent[0][1]["manufacturer"], sent[0][1]["serialNumber"]),
                         ("2.1.0", "acme", "0815"))


if __name__ == "__main__":
    unittest.main()
