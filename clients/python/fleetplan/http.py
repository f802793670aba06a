"""HTTP for a client of the service: connections that are kept, events as they arrive, and bounds.

An exchange has a deadline as a whole and a largest answer, whatever the server does. For example, it may send a byte a
second, or send without an end.
"""

import http.client
import io
import json
import socket
import ssl
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NoReturn
from urllib.parse import urlsplit

from fleetplan.errors import ConnectionFailed, InvalidAnswer, InvalidValue, shown

_LOST = (OSError, http.client.HTTPException, ValueError, MemoryError)  # ValueError: lengths and names that are none
_MAX_IDLE = 4  # connections that are kept
_PIECE = 1 << 16  # bytes
_MAX_SECONDS = 7 * 86400.0  # of an exchange


@dataclass(frozen=True)
class Event:
    """A server-sent event."""

    name: str
    data: str


class _TooLarge(OSError):
    """An answer has more bytes than it may have."""


class Bounds:
    """Of one exchange."""

    def __init__(self, silence: float, whole: float, max_bytes: int) -> None:
        """`silence`: seconds for which the server may be silent. `whole`: seconds for all. `max_bytes`: of the answer,
        or of each event."""
        self.silence = min(silence, _MAX_SECONDS)
        self._max_bytes = self._bytes_left = max_bytes
        self._heard = time.monotonic()
        self._until = self._heard + min(whole, _MAX_SECONDS)

    def patience(self) -> float:
        """Seconds for which to wait for the next bytes."""
        left = min(self.silence, self._until - time.monotonic())
        if left <= 0.0:
            raise TimeoutError
        return left

    def count(self, received: int) -> None:
        self._heard = time.monotonic()
        self._bytes_left -= received
        if self._bytes_left < 0:
            raise _TooLarge("the answer is too large")

    def pass_event(self, seconds: float) -> None:
        """An event has come to its end. What the caller does with it takes so long, which does not count."""
        self._bytes_left = self._max_bytes
        self._until += seconds

    @property
    def max_line(self) -> int:
        """Bytes; more do not come."""
        return self._max_bytes + _PIECE

    @property
    def is_silent(self) -> bool:
        return time.monotonic() - self._heard >= 0.9 * self.silence


class _Reader(io.RawIOBase):
    """What comes on a socket, within the bounds of the exchange under way."""

    def __init__(self, bounded: "_BoundedSocket") -> None:
        self._bounded = bounded
        self._raw = bounded.socket.makefile("rb", buffering=0)  # keeps the socket open until this is closed

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int | None:
        self._bounded.socket.settimeout(self._bounded.bounds.patience())
        received = self._raw.readinto(buffer)
        self._bounded.bounds.count(received or 0)
        return received

    def close(self) -> None:
        self._raw.close()
        super().close()


class _BoundedSocket:
    """What http.client uses of a socket."""

    def __init__(self, connected: socket.socket, limits: Bounds) -> None:
        self.socket, self.bounds = connected, limits

    def makefile(self, _mode: str) -> io.BufferedReader:
        return io.BufferedReader(_Reader(self), _PIECE)

    def sendall(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            self.socket.settimeout(self.bounds.patience())
            rest = rest[self.socket.send(rest[:_PIECE]):]

    def close(self) -> None:
        self.socket.close()


class _Connection(http.client.HTTPConnection):
    """A connection, of https if it has a context."""

    def __init__(self, host: str, port: int | None, context: ssl.SSLContext | None) -> None:
        self.default_port = http.client.HTTP_PORT if context is None else http.client.HTTPS_PORT
        super().__init__(host, port)
        self.bounds = Bounds(0.0, 0.0, 0)  # of the exchange under way
        self._context = context

    def connect(self) -> None:
        connected = _connected(self.host, self.port, self.bounds)
        try:
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            if self._context is not None:
                connected = self._context.wrap_socket(connected, server_hostname=self.host, do_handshake_on_connect=False)
                connected.settimeout(self.bounds.patience())
                connected.do_handshake()
        except BaseException:
            connected.close()
            raise
        self.sock: Any = _BoundedSocket(connected, self.bounds)

    def begin(self, limits: Bounds) -> None:
        """The next exchange."""
        self.bounds = limits
        if self.sock is not None:
            self.sock.bounds = limits

    def is_quiet(self) -> bool:
        """Whether a connection that was kept can be used again: it is open, and nothing came that was not asked for."""
        if self.sock is None:
            return False
        try:
            self.sock.socket.settimeout(0.0)
            socket.socket.recv(self.sock.socket, 1, socket.MSG_PEEK)  # below TLS, too
            return False
        except BlockingIOError:
            return True
        except OSError:
            return False


def _connected(host: str, port: int, limits: Bounds) -> socket.socket:
    failed: OSError = OSError("the name has no address")
    for family, kind, protocol, _, address in socket.getaddrinfo(host, port, 0, socket.SOCK_STREAM):
        opened = socket.socket(family, kind, protocol)
        try:
            opened.settimeout(limits.patience())
            opened.connect(address)
            return opened
        except OSError as error:
            opened.close()
            failed = error
    raise failed


class Response:
    """An answer whose body is still to be read. Close it, or read all of it: then its connection is kept."""

    def __init__(self, pool: "Pool", connection: _Connection, raw: http.client.HTTPResponse) -> None:
        self._pool, self._connection, self._raw = pool, connection, raw
        self._bounds = connection.bounds
        self.status = raw.status
        self.reason = raw.reason
        self.retry_after = raw.headers.get("Retry-After")

    def __enter__(self) -> "Response":
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def read(self) -> bytes:
        """The whole body."""
        pieces = []
        try:
            while piece := self._raw.read(_PIECE):
                pieces.append(piece)
            if self._raw.length:
                raise http.client.IncompleteRead(b"", self._raw.length)
            return b"".join(pieces)
        except _LOST as error:
            self._fail(error)

    def events(self) -> Iterator[Event]:
        """The events of a stream (WHATWG HTML, server-sent events) as they arrive. The time that the caller takes for
        an event does not count."""
        name, data = "message", list[str]()
        while line := self._line():
            text = line.rstrip(b"\r\n").decode(errors="replace")
            field, _, value = text.partition(":")
            value = value.removeprefix(" ")
            if field == "event":
                name = value
            elif field == "data":
                data.append(value)
            elif text == "":
                if data:
                    given = time.monotonic()
                    yield Event(name, "\n".join(data))
                    self._bounds.pass_event(time.monotonic() - given)
                name, data = "message", []

    def _line(self) -> bytes:
        try:
            return self._raw.readline(self._bounds.max_line)
        except _LOST as error:
            self._fail(error)

    def _fail(self, error: BaseException) -> NoReturn:
        if isinstance(error, _TooLarge | MemoryError):
            raise InvalidAnswer(f"the answer of {self._pool.url} is too large") from error
        if isinstance(error, TimeoutError):
            raise self._pool.late(self._bounds) from error
        raise ConnectionFailed(f"the answer of {self._pool.url} broke off: {shown(str(error))}") from error

    def close(self) -> None:
        """An answer that is not read to its end takes its connection with it: the service stops computing it."""
        if self._raw.isclosed() and not self._raw.will_close:
            self._pool.keep(self._connection)
        else:
            self._raw.close()
            self._connection.close()


class Pool:
    """The connections to one server. Threads may share it."""

    def __init__(self, url: str, context: ssl.SSLContext | None = None) -> None:
        """`context`: for https. By default, certificates are checked against the certificates that the system trusts.
        """
        try:
            parts = urlsplit(url)
            self._host, self._port = parts.hostname or "", parts.port
        except ValueError as error:
            raise InvalidValue(f"{shown(url)} is not a URL: {error}") from error
        if parts.scheme not in ("http", "https") or not self._host:
            raise InvalidValue(f"{shown(url)} is not the URL of a server, such as http://localhost:8080")
        self.url = url.rstrip("/")
        self._path = parts.path.rstrip("/")
        if parts.scheme == "https" and context is None:
            context = ssl.create_default_context()
        self._context = context if parts.scheme == "https" else None
        self._idle: list[_Connection] = []
        self._lock = threading.Lock()

    def send(self, method: str, path: str, headers: Mapping[str, str], body: bytes | None, limits: Bounds) -> Response:
        """The server may have closed a connection that was kept. Then the request is sent once more on a new
        connection. This is safe, because every request is a pure function."""
        kept = self._take()
        try:
            if kept is not None:
                try:
                    return self._send_on(kept, method, path, headers, body, limits)
                except TimeoutError:
                    raise
                except _LOST:
                    pass
            connection = _Connection(self._host, self._port, self._context)
            return self._send_on(connection, method, path, headers, body, limits)
        except TimeoutError as error:
            raise self.late(limits) from error
        except _LOST as error:
            raise ConnectionFailed(f"{self.url} does not answer: {shown(str(error))}") from error

    def keep(self, connection: _Connection) -> None:
        with self._lock:
            if len(self._idle) < _MAX_IDLE:
                self._idle.append(connection)
                return
        connection.close()

    def close(self) -> None:
        with self._lock:
            idle, self._idle = self._idle, []
        for connection in idle:
            connection.close()

    def _take(self) -> _Connection | None:
        while True:
            with self._lock:
                if not self._idle:
                    return None
                kept = self._idle.pop()
            if kept.is_quiet():
                return kept
            kept.close()

    def _send_on(self, connection: _Connection, method: str, path: str, headers: Mapping[str, str],
                 body: bytes | None, limits: Bounds) -> Response:
        try:
            connection.begin(limits)
            connection.request(method, self._path + path, body, dict(headers))
            return Response(self, connection, connection.getresponse())
        except BaseException:
            connection.close()
            raise

    def late(self, limits: Bounds) -> ConnectionFailed:
        """What to raise when time is over."""
        if limits.is_silent:
            return ConnectionFailed(f"{self.url} has been silent for {limits.silence:g} s")
        return ConnectionFailed(f"the answer of {self.url} takes too long")


def read_json(text: bytes | str) -> object:
    """The value, or nothing if it is not JSON or is nested too deeply to be read."""
    try:
        value: object = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError, MemoryError):
        return None
    return value


def write_json(value: object) -> str:
    """The text of a value that JSON has."""
    try:
        return json.dumps(value, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise InvalidValue(f"there is a value that cannot be written as JSON: {shown(str(error))}") from error


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")
