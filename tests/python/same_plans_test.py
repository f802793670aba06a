"""The same version gives the same plans on every machine. Here, with and without fused multiply-add, for which the C
library has other sines. With these sines, one in twenty of the plans differed."""

import random
import unittest

from support import service

from fleetplan import Client

WITHOUT = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}  # as on a CPU that has neither
SIDE = 40  # metres
ROBOTS = 60
HALLS = 100


def hall(seed):
    """A request with robots in any direction of each other."""
    dice = random.Random(seed)

    def places():
        cells = [(x, y) for x in range(1, SIDE - 1, 2) for y in range(1, SIDE - 1, 2)]
        return [{"x": x + 0.5 + dice.uniform(-0.3, 0.3), "y": y + 0.5 + dice.uniform(-0.3, 0.3)}
                for x, y in dice.sample(cells, ROBOTS)]
    return {"map": {"rows": ["." * SIDE] * SIDE},
            "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
            "robots": [{"id": str(number), "start": start, "goal": goal}
                       for number, (start, goal) in enumerate(zip(places(), places(), strict=True))],
            "options": {"time_budget_ms": 20000}}


class SamePlans(unittest.TestCase):
    def test_plans_are_the_same_without_fused_multiply_add(self):
        with service() as url, service(**WITHOUT) as other_url, Client(url) as client, Client(other_url) as other:
            for seed in range(HALLS):
                with self.subTest(seed=seed):
                    one, two = client.plan(hall(seed)), other.plan(hall(seed))
                    self.assertTrue(one["deterministic"] and two["deterministic"])
                    self.assertEqual(one["plans"], two["plans"])


if __name__ == "__main__":
    unittest.main()
