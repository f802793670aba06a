"""A plain HTTP/1.1 client on one socket, which sends the given bytes unchanged."""

import gzip
import json
import socket
import time


class Lost(Exception):
    """No answer, or an incomplete one."""


class Answer:
    def __init__(self, status, fields, body):
        self.status, self.fields, self.body = status, fields, body

    def json(self):
        return json.loads(self.body)


class Connection:
    """One connection, opened when needed and again after the server has closed it."""

    # The server closes idle connections after a second. So a connection that was used more recently is still open.
    MAX_IDLE_S = 0.5

    def __init__(self, host, port, timeout=90.0, source=None):
        """`source`: the address to connect from."""
        self.address, self.timeout, self.source = (host, port), timeout, (source, 0) if source else None
        self.socket, self.input, self.used_at = None, bytearray(), 0.0

    def close(self):
        if self.socket:
            self.socket.close()
        self.socket, self.input = None, bytearray()

    def open(self):
        if self.socket and time.monotonic() - self.used_at > self.MAX_IDLE_S:
            self.close()
        if not self.socket:
            self.socket = socket.create_connection(self.address, self.timeout, self.source)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data):
        self.open()
        self.send_more(data)

    def send_more(self, data):
        """Sends more of a request that began with send()."""
        try:
            self.socket.sendall(data)
        except OSError:
            pass  # the server may have answered early and closed; that answer can still be read

    def receive(self, head_only=False):
        """Reads the next complete answer; closes the connection if the answer requires it."""
        head = self._until(b"\r\n\r\n").decode("latin-1")
        status = int(head.split(" ", 2)[1])
        fields = {}
        for line in head.split("\r\n")[1:]:
            name, _, value = line.partition(":")
            fields[name.lower()] = value.strip()
        if status == 100:
            return self.receive(head_only)
        body = b"" if head_only else self._body(fields)
        if fields.get("content-encoding") == "gzip":
            body = gzip.decompress(body)
        self.used_at = time.monotonic()
        if fields.get("connection", "").lower() == "close":
            self.close()
        return Answer(status, fields, body)

    def _body(self, fields):
        if "content-length" in fields:
            return self._exactly(int(fields["content-length"]))
        if fields.get("transfer-encoding") != "chunked":
            return self._rest()
        body = b""
        while size := int(self._until(b"\r\n"), 16):
            body += self._exactly(size + 2)[:-2]
        self._until(b"\r\n")
        return body

    def _more(self):
        try:
            data = self.socket.recv(1 << 16) if self.socket else b""
        except OSError as error:
            raise Lost(str(error)) from error
        if not data:
            raise Lost(f"the connection ended after {len(self.input)} bytes")
        self.input += data

    def _until(self, mark):
        searched = 0
        while (end := self.input.find(mark, searched)) < 0:
            searched = max(0, len(self.input) - len(mark))
            self._more()
        head = bytes(self.input[:end])
        del self.input[:end + len(mark)]
        return head

    def _exactly(self, size):
        while len(self.input) < size:
            self._more()
        part = bytes(self.input[:size])
        del self.input[:size]
        return part

    def _rest(self):
        try:
            while True:
                self._more()
        except Lost:
            return self._exactly(len(self.input))


def request(method, path, body=None, fields=()):
    """The bytes of a request; `fields`: pairs."""
    lines = [f"{method} {path} HTTP/1.1", "Host: localhost"]
    lines += [f"{name}: {value}" for name, value in fields]
    if body is not None:
        lines += ["Content-Type: application/json", f"Content-Length: {len(body)}"]
    return ("\r\n".join(lines) + "\r\n\r\n").encode() + (body or b"")
