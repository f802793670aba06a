import unittest

from chart import hall_panels, legend_of
from summary import summarise_halls
from support import run


class Chart(unittest.TestCase):
    def setUp(self):
        self.panels = hall_panels(summarise_halls([
            run(15, 1.0, 110.0), run(15, 3.0, 130.0), run(300, 60.0), run(15, 2.0, 150.0, "rects/1")]))

    def test_it_shows_success_time_cost_and_makespan_of_every_hall(self):
        # Two halls in each panel, the 90 % lines, and the paper's line in two pieces.
        self.assertEqual([len(panel.lines) for panel in self.panels], [2 + 2, 2 + 2, 2, 2])
        success, runtime, flowtime, makespan = ([line.points for line in panel.lines] for panel in self.panels)
        self.assertEqual(success[0], [(15, 100.0), (300, 0.0)])
        self.assertEqual(runtime[0], [(15, 2.0), (300, 60.0)])
        self.assertAlmostEqual(runtime[2][0][1], 2.8)
        self.assertAlmostEqual(flowtime[1][0][1], 1.5)
        self.assertEqual(makespan[1], [(15, 15.0)])

    def test_unsolved_numbers_of_robots_have_no_cost(self):
        self.assertEqual([x for x, _ in self.panels[2].lines[0].points], [15])

    def test_the_papers_success_is_drawn_where_its_text_states_it(self):
        self.assertEqual([line.points for line in self.panels[0].lines[2:]],
                         [[(15, 100.0), (210, 100.0)], [(285, 10.0), (300, 10.0)]])

    def test_every_name_is_in_the_legend_once(self):
        names = [line.name for line in legend_of(self.panels)]
        self.assertEqual(names[:2], ["empty", "rects"])
        self.assertEqual(len(names), 3)
        self.assertFalse(legend_of(self.panels)[0].dashed)


if __name__ == "__main__":
    unittest.main()
