"""The server under test: a child process, or a server that is already running."""

import json
import os
import re
import subprocess
import urllib.parse
import urllib.request


class Server:
    def __init__(self, binary=None, url=None, flags=(), **process):
        self.process, self.url, self.admin_url = None, url, None
        if not url:
            level = [] if "--log-level" in flags else ["--log-level", "off"]
            self.process = subprocess.Popen([binary, "--port", "0", *level, *flags],
                                            stdout=subprocess.PIPE, text=True, **process)
            self.url = self._read_url()
            if "--admin-port" in flags:
                self.admin_url = self._read_url()
        parts = urllib.parse.urlsplit(self.url)
        self.host, self.port = parts.hostname, parts.port or 80

    def _read_url(self):
        return re.search(r"http://\S+", self.process.stdout.readline()).group()

    def get(self, path):
        with urllib.request.urlopen(self.url + path, timeout=30) as response:
            return json.load(response)

    def resident_kib(self):
        """Resident memory; None if the server is not a child process or has ended."""
        return self._status("VmRSS")

    def kept_maps_kib(self):
        """Memory of the maps that are kept for later requests, which --map-cache bounds."""
        return self.metric("fleetplan_map_cache_bytes") / 1024

    def metric(self, name):
        with urllib.request.urlopen(f"{self.url}/metrics", timeout=30) as response:
            return float(re.search(rf"^{name} (\S+)$", response.read().decode(), re.MULTILINE).group(1))

    def peak_kib(self):
        return self._status("VmHWM")

    def _status(self, name):
        try:
            with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
                return int(re.search(rf"{name}:\s+(\d+) kB", status.read()).group(1))
        except (AttributeError, OSError):
            return None

    def cpu_seconds(self):
        """CPU time of the child process so far."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as stat:
            user, system = stat.read().rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def alive(self):
        return self.process is None or self.process.poll() is None

    def end(self):
        """Ends the child process, if any; returns its exit code."""
        if not self.process:
            return 0
        self.process.terminate()
        code = self.process.wait(60)
        self.process.stdout.close()
        return code
