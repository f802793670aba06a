"""What peers send that is not what they should send: damaged values, and servers on a socket."""

import contextlib
import copy
import json
import math
import socket
import threading

VALUES = [None, "x", "", True, -1, 0, 1.5, 10 ** 400, 1e300, math.nan, math.inf, -math.inf, [], {}, [None], [[]], {"x": 1},
          "\ud800", "\x00", ["x"] * 50]


def damaged(value, dice):
    """A copy with one or two values changed, removed or repeated, anywhere."""
    whole = copy.deepcopy(value)
    for _ in range(dice.randint(1, 2)):
        at = whole
        while True:
            names = list(at) if isinstance(at, dict) else range(len(at))
            if not names:
                break
            name = dice.choice(list(names))
            if isinstance(at[name], dict | list) and dice.random() < 0.7:
                at = at[name]
                continue
            kind = dice.random()
            if kind < 0.25:
                del at[name]
            elif kind < 0.3 and isinstance(at, list):
                at.append(copy.deepcopy(at[name]))
            else:
                at[name] = copy.deepcopy(dice.choice(VALUES))
            break
    return whole


def damaged_text(value, dice):
    """The same as bytes, which need not be JSON either."""
    text = json.dumps(damaged(value, dice)).encode()
    kind = dice.randrange(12)
    if kind == 0:
        return text[:dice.randrange(len(text))]
    if kind == 1:
        return b"[" * 100000
    if kind == 2:
        return b"\xff\xfe" + text
    if kind == 3:
        return dice.choice([b"", b"null", b"[]", b"{}", b"7", b'"x"', b"<html>", b"NaN", b"\xef\xbb\xbf{}"])
    if kind == 4:
        return b'{"a":' * 5000 + text + b"}" * 5000
    return text


@contextlib.contextmanager
def raw_server(answer):
    """The URL of a server. `answer` writes to the connection of a request whatever it likes; requests are counted in the
    list that comes with it."""
    listener = socket.create_server(("127.0.0.1", 0))
    asked, ended = [], threading.Event()

    def serve(connection):
        with connection, contextlib.suppress(OSError):
            received = b""
            while not ended.is_set():
                while b"\r\n\r\n" not in received:
                    more = connection.recv(65536)
                    if not more:
                        return
                    received += more
                head, _, received = received.partition(b"\r\n\r\n")
                length = next((int(line.split(b":")[1]) for line in head.lower().split(b"\r\n")
                               if line.startswith(b"content-length:")), 0)
                while len(received) < length:
                    received += connection.recv(65536)
                received = received[length:]
                asked.append(head)
                answer(connection, ended)

    def accept():
        with contextlib.suppress(OSError):
            while True:
                connection, _ = listener.accept()
                threading.Thread(target=serve, args=(connection,), daemon=True).start()

    thread = threading.Thread(target=accept, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}", asked
    finally:
        ended.set()
        listener.shutdown(socket.SHUT_RDWR)
        listener.close()
        thread.join()
