"""HTTP with what a client of the service needs: connections that are kept, and events as they arrive."""

import http.client
import json
import ssl
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import TracebackType
from urllib.parse import urlsplit

from fleetplan.errors import ConnectionFailed

_LOST = (OSError, http.client.HTTPException)
_MOST_IDLE = 4  # connections that are kept


@dataclass(frozen=True)
class Event:
    """A server-sent event."""

    name: str
    data: str


class Response:
    """An answer whose body is still to be read. Close it, or read all of it: then its connection is kept."""

    def __init__(self, pool: "Pool", connection: http.client.HTTPConnection, raw: http.client.HTTPResponse) -> None:
        self._pool, self._connection, self._raw = pool, connection, raw
        self.status = raw.status
        self.reason = raw.reason
        self.retry_after = raw.headers.get("Retry-After")

    def __enter__(self) -> "Response":
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def read(self) -> bytes:
        try:
            return self._raw.read()
        except _LOST as error:
            raise ConnectionFailed(f"the answer of {self._pool.url} broke off: {error}") from error

    def events(self) -> Iterator[Event]:
        """The events of a stream (WHATWG HTML, server-sent events) as they arrive."""
        name, data = "message", list[str]()
        while line := self._line():
            text = line.rstrip(b"\r\n").decode()
            field, _, value = text.partition(":")
            value = value.removeprefix(" ")
            if field == "event":
                name = value
            elif field == "data":
                data.append(value)
            elif text == "":
                if data:
                    yield Event(name, "\n".join(data))
                name, data = "message", []

    def _line(self) -> bytes:
        try:
            return self._raw.readline()
        except _LOST as error:
            raise ConnectionFailed(f"the answer of {self._pool.url} broke off: {error}") from error

    def close(self) -> None:
        """An answer that is not read to its end takes its connection with it: the service stops computing it."""
        if self._raw.isclosed() and not self._raw.will_close:
            self._pool.keep(self._connection)
        else:
            self._connection.close()


class Pool:
    """The connections to one server. Threads may share it."""

    def __init__(self, url: str, context: ssl.SSLContext | None = None) -> None:
        """`context`: of https; by default, certificates are checked against those that the system trusts."""
        parts = urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"{url!r} is not the URL of a server, such as http://localhost:8080")
        self.url = url.rstrip("/")
        self._path = parts.path.rstrip("/")
        self._secure, self._host, self._port = parts.scheme == "https", parts.hostname, parts.port
        self._context = context
        self._idle: list[http.client.HTTPConnection] = []
        self._lock = threading.Lock()

    def send(self, method: str, path: str, headers: Mapping[str, str], body: bytes | None, timeout: float) -> Response:
        """`timeout`: seconds for which the server may be silent. The server may have closed a connection that was
        kept; then the request is sent once more on a new one, which is safe, as every request is a pure function."""
        kept = self._take()
        if kept is not None:
            try:
                return self._send_on(kept, method, path, headers, body, timeout)
            except TimeoutError as error:
                raise self._silent(timeout) from error
            except _LOST:
                pass
        try:
            return self._send_on(self._connect(), method, path, headers, body, timeout)
        except TimeoutError as error:
            raise self._silent(timeout) from error
        except _LOST as error:
            raise ConnectionFailed(f"{self.url} does not answer: {error}") from error

    def keep(self, connection: http.client.HTTPConnection) -> None:
        with self._lock:
            if len(self._idle) < _MOST_IDLE:
                self._idle.append(connection)
                return
        connection.close()

    def close(self) -> None:
        with self._lock:
            idle, self._idle = self._idle, []
        for connection in idle:
            connection.close()

    def _take(self) -> http.client.HTTPConnection | None:
        with self._lock:
            return self._idle.pop() if self._idle else None

    def _connect(self) -> http.client.HTTPConnection:
        if self._secure:
            return http.client.HTTPSConnection(self._host, self._port, context=self._context)
        return http.client.HTTPConnection(self._host, self._port)

    def _send_on(self, connection: http.client.HTTPConnection, method: str, path: str, headers: Mapping[str, str],
                 body: bytes | None, timeout: float) -> Response:
        try:
            connection.timeout = timeout
            if connection.sock is not None:
                connection.sock.settimeout(timeout)
            connection.request(method, self._path + path, body, dict(headers))
            return Response(self, connection, connection.getresponse())
        except BaseException:
            connection.close()
            raise

    def _silent(self, timeout: float) -> ConnectionFailed:
        return ConnectionFailed(f"{self.url} has been silent for {timeout:g} s")


def read_json(text: bytes | str) -> object:
    """The value, or nothing if it is not JSON."""
    try:
        value: object = json.loads(text)
    except ValueError:
        return None
    return value
