"""Tells what peers have done wrong: to a function, and to the log."""

import logging
import threading
import time
from collections.abc import Callable

from fleetplan.errors import FleetplanError

_LOG = logging.getLogger("fleetplan")
_AGAIN = 60.0  # seconds: the same is not logged more often
_MAX = 1000  # different ones that are remembered

OnFault = Callable[[FleetplanError], None]


class Faults:
    """Threads may share it."""

    def __init__(self, on_fault: OnFault | None = None) -> None:
        """`on_fault`: called with each, in whatever thread has found it."""
        self._on_fault = on_fault
        self._lock = threading.Lock()
        self._logged: dict[str, float] = {}

    def tell(self, fault: FleetplanError) -> None:
        text = str(fault).encode("ascii", "backslashreplace").decode()
        if self._is_news(text):
            _LOG.warning("%s", text)
        if self._on_fault is not None:
            try:
                self._on_fault(fault)
            except Exception:  # of the caller's function, which is not to end the thread that listens to all others
                _LOG.exception("on_fault has raised an exception")

    def _is_news(self, text: str) -> bool:
        now = time.monotonic()
        with self._lock:
            if now - self._logged.get(text, -_AGAIN) < _AGAIN:
                return False
            if len(self._logged) >= _MAX:
                self._logged.clear()
            self._logged[text] = now
            return True
