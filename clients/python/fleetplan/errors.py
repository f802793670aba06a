"""What goes wrong: every exception of this package is a FleetplanError."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


_LONGEST = 200  # characters of a value in a message


class FleetplanError(Exception):
    """The base of all exceptions of this package."""


class ConnectionFailed(FleetplanError):
    """There is no answer: no server listens, the connection ended, or the server was silent for too long."""


class InvalidAnswer(ConnectionFailed):
    """What came is no answer of the service: it is not JSON, not of the expected shape, or too large."""


class InvalidValue(FleetplanError, ValueError):
    """A value of the caller that cannot be used: a number that JSON does not have, a URL without a host, a plan without
    dependencies."""


class MessageRejected(FleetplanError):
    """What one robot or vehicle has sent is not used. Nobody else is affected."""

    def __init__(self, sender: str, reason: str) -> None:
        self.sender, self.reason = sender, reason  # the sender: a robot, or the topic of a message
        super().__init__(f"{shown(sender)}: {reason}")


class VehicleUnavailable(FleetplanError):
    """A vehicle cannot do what it is told, for now: it gets no goals until it can. Others go on."""

    def __init__(self, robot: str, reason: str) -> None:
        self.robot, self.reason = robot, reason
        super().__init__(f"{shown(robot)} is not available: {reason}")


class RoundFailed(FleetplanError):
    """A round has ended by an error that is not foreseen."""


class PlanDropped(FleetplanError):
    """The plan was dropped. It was made while robots drove, and some of them could no longer stop before its closed
    gates. This lasted for so long that the next plan is better."""


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
        self.faults_total = total if isinstance(total, int) and not isinstance(total, bool) else len(self.faults)
        super().__init__(str(self))

    def __str__(self) -> str:
        lines = [f"{self.status} {self.code}: {self.detail}".replace(" :", ":")]
        lines += [f"  {fault}" for fault in self.faults]
        if self.faults_total > len(self.faults):
            lines.append(f"  and {self.faults_total - len(self.faults)} more")
        return "\n".join(lines)


class RequestRefused(ProblemError):
    """The request is at fault (4xx): sending it again changes nothing."""

    robots: frozenset[str] = frozenset()  # raised by a loop: whose goals are at fault


class ServiceUnavailable(ProblemError):
    """The service is busy or shutting down (503), for longer than the client waits."""


def shown(value: object) -> str:
    """For messages: what others have sent, without control characters, and cut."""
    try:
        text = ascii(value)
    except RecursionError:
        text = f"a {type(value).__name__} that is nested too deeply"
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def problem_error(status: int, problem: Mapping[str, object]) -> ProblemError:
    """The exception for an answer with this status."""
    if status == 503:
        return ServiceUnavailable(status, problem)
    return RequestRefused(status, problem) if 400 <= status < 500 else ProblemError(status, problem)


def _faults(errors: object) -> tuple[Fault, ...]:
    if not isinstance(errors, Sequence) or isinstance(errors, str):
        return ()
    return tuple(Fault(str(error.get("pointer", "")), str(error.get("code", "")), str(error.get("detail", "")))
                 for error in errors if isinstance(error, Mapping))
