"""What goes wrong: every exception of this package is a FleetplanError."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


class FleetplanError(Exception):
    """The base of all exceptions of this package."""


class ConnectionFailed(FleetplanError):
    """There is no answer: nobody listens, the connection ended, or the server was silent for too long."""


class PlanDropped(FleetplanError):
    """Robots could not stop any more before closed gates of a plan that was made while they drove, for so long that the
    next plan is better."""


@dataclass(frozen=True)
class Fault:
    """One fault of a request."""

    pointer: str  # JSON Pointer (RFC 6901) to the smallest value that is wrong
    code: str  # stable, for programs
    detail: str  # the message, for people, with what to do about it

    @property
    def remedy(self) -> str:
        """What to do, if the message says so after a semicolon: "give only one"."""
        return self.detail.rpartition("; ")[2].rstrip(".") if "; " in self.detail else ""

    @property
    def message(self) -> str:
        """What is wrong: the detail without the remedy."""
        return self.detail.rpartition("; ")[0] if "; " in self.detail else self.detail

    def __str__(self) -> str:
        return f"{self.pointer or '(the request)'}: {self.detail}"


class ProblemError(FleetplanError):
    """The service answers with an error: problem details (RFC 9457)."""

    def __init__(self, status: int, problem: Mapping[str, object]) -> None:
        self.status = status  # of HTTP
        self.code = str(problem.get("code", ""))  # stable, for programs
        self.detail = str(problem.get("detail", ""))
        self.request_id = str(problem.get("request_id", ""))
        self.faults = _faults(problem.get("errors"))  # the first twenty
        total = problem.get("errors_total", len(self.faults))
        self.faults_total = total if isinstance(total, int) else len(self.faults)
        super().__init__(str(self))

    def __str__(self) -> str:
        lines = [f"{self.status} {self.code}: {self.detail}".replace(" :", ":")]
        lines += [f"  {fault}" for fault in self.faults]
        if self.faults_total > len(self.faults):
            lines.append(f"  and {self.faults_total - len(self.faults)} more")
        return "\n".join(lines)


class RequestRefused(ProblemError):
    """The request is at fault (4xx): sending it again changes nothing."""


class ServiceUnavailable(ProblemError):
    """The service is busy or shutting down (503), for longer than the client waits."""


def problem_error(status: int, problem: Mapping[str, object]) -> ProblemError:
    """The exception for an answer with this status."""
    if status == 503:
        return ServiceUnavailable(status, problem)
    return RequestRefused(status, problem) if 400 <= status < 500 else ProblemError(status, problem)


def _faults(errors: object) -> tuple[Fault, ...]:
    if not isinstance(errors, Sequence):
        return ()
    return tuple(Fault(str(error.get("pointer", "")), str(error.get("code", "")), str(error.get("detail", "")))
                 for error in errors if isinstance(error, Mapping))
