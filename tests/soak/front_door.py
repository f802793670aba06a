"""Faults of the machine around the server: each check starts a server of its own and returns a fault or None."""

import ctypes
import os
import resource
import signal
import socket
import subprocess
import time

from client import Connection, Lost, request
from server import Server

SYS_PIDFD_GETFD = 438
EXIT_S = 30


def _healthy(server):
    connection = Connection(server.host, server.port, 20)
    connection.send(request("GET", "/healthz"))
    status = connection.receive().status
    connection.close()
    return status == 200


def unread_log(binary):
    """Nobody reads stderr, which is a pipe: requests are served, and SIGTERM ends the server."""
    server = Server(binary, flags=["--log-level", "info"], stderr=subprocess.PIPE)
    connection = Connection(server.host, server.port, 20)
    try:
        for _ in range(6000):
            connection.send(request("GET", "/healthz", fields=[("X-Request-Id", "a" * 128)]))
            connection.receive()
        connection.send(request("GET", "/metrics"))
        metrics = connection.receive().body.decode()
        connection.close()
        if "\nfleetplan_log_lines_dropped_total 0\n" in metrics:
            return "no line of the log was dropped"
        code = server.end()
        return f"the server ended with {code}" if code else None
    except (Lost, OSError, subprocess.TimeoutExpired) as fault:
        server.process.kill()
        return str(fault)


def few_descriptors(binary):
    """All descriptors are used up by idle connections: new clients are served, without spinning."""
    server = Server(binary, flags=["--idle-timeout-ms", "600000"],
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (48, 48)))
    idle = [socket.create_connection((server.host, server.port)) for _ in range(200)]
    try:
        served = all(_healthy(server) for _ in range(20))
        before = server.cpu_seconds()
        time.sleep(2)
        spent = server.cpu_seconds() - before
    except (Lost, OSError) as fault:
        return str(fault)
    finally:
        for connection in idle:
            connection.close()
        code = server.end()
    if not served:
        return "a client was not served"
    if spent > 0.5:
        return f"{spent} s of CPU in 2 s"
    return f"the server ended with {code}" if code else None


def broken_listener(binary):
    """The listening socket stops listening: the server ends with 1."""
    server = Server(binary)
    process = os.pidfd_open(server.process.pid)
    for number in range(64):
        copy = ctypes.CDLL(None).syscall(SYS_PIDFD_GETFD, process, number, 0)
        if copy < 0:
            continue
        try:
            with socket.socket(fileno=copy) as copied:
                if copied.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                    copied.shutdown(socket.SHUT_RDWR)
        except OSError:
            os.close(copy)
    os.close(process)
    try:
        code = server.process.wait(EXIT_S)
    except subprocess.TimeoutExpired:
        server.process.send_signal(signal.SIGKILL)
        return "the server goes on without listening"
    finally:
        server.process.stdout.close()
    return None if code == 1 else f"the server ended with {code}"


CHECKS = {"a log that nobody reads": unread_log, "no descriptors left": few_descriptors,
          "a listener that breaks": broken_listener}
