"""A client of Fleetplan, which plans the motions of fleets of robots: see docs/python.md.

- `Client`: the endpoints of the service as methods.
- `Executor`: executes a plan by robots that are late.
- `FleetLoop`: plans a fleet again and again while it drives.
- `fleetplan.simulation`: robots for tests and examples.
- `fleetplan.types`: requests and answers.
"""

from fleetplan.client import Client
from fleetplan.errors import (ConnectionFailed, Fault, FleetplanError, InvalidAnswer, InvalidValue, MessageRejected,
                              PlanDropped, ProblemError, RequestRefused, RoundFailed, ServiceUnavailable,
                              VehicleUnavailable)
from fleetplan.executor import Executor, Instruction, Report
from fleetplan.fleet_loop import FleetLoop

__all__ = [
    "Client", "ConnectionFailed", "Executor", "Fault", "FleetLoop", "FleetplanError", "Instruction", "InvalidAnswer",
    "InvalidValue", "MessageRejected", "PlanDropped", "ProblemError", "Report", "RequestRefused", "RoundFailed",
    "ServiceUnavailable", "VehicleUnavailable",
]
