"""The chart of the paper's workloads: success rate, runtime, cost and makespan against the number of robots."""

import dataclasses

import paper

TITLE = "Fleetplan on the workloads of the AA-SIPP(m) paper (64 x 64 cells, three types of robots)"
PAPER_NAME = "empty, the paper's planner according to its text: all up to 210 robots, below 10 % from 285"
COLOURS = ["#1f6fb4", "#c8501e"]  # of the halls, in turn
PAPER_COLOUR = "#888888"


@dataclasses.dataclass(frozen=True)
class Line:
    name: str  # in the legend
    colour: str
    points: list  # of (x, y), by x
    dashed: bool = False


@dataclasses.dataclass(frozen=True)
class Panel:
    title: str  # what y is
    lines: list
    logarithmic: bool = False
    from_zero: bool = False


def line_of(hall, summaries, colour, value, dashed=False):
    """A line through the values of the summaries that have one."""
    points = [(summary.robots, value(summary)) for summary in summaries]
    return Line(hall, colour, [(x, y) for x, y in points if y is not None], dashed)


def paper_lines():
    """The paper's own success rate in the empty hall, where its text states one."""
    def level(first, last, rate):
        return Line(PAPER_NAME, PAPER_COLOUR, [(first, 100 * rate), (last, 100 * rate)], dashed=True)

    return [level(paper.ROBOTS[0], paper.ALL_SOLVED_UP_TO, 1.0),
            level(paper.FEW_SOLVED_FROM, paper.ROBOTS[-1], paper.FEW_SOLVED)]


def hall_panels(halls):
    """The panels of the summaries by hall."""
    def lines(value, dashed=False):
        return [line_of(hall, summaries, COLOURS[index % len(COLOURS)], value, dashed)
                for index, (hall, summaries) in enumerate(halls.items())]

    return [
        Panel("instances solved, %", lines(lambda summary: 100 * summary.success_rate) + paper_lines(),
              from_zero=True),
        Panel("seconds: median; dashed: 90 % are below",
              lines(lambda summary: summary.median_seconds) +
              lines(lambda summary: summary.percentile_90_seconds, dashed=True), logarithmic=True),
        Panel("flowtime / lower bound, mean", lines(lambda summary: summary.flowtime_by_bound)),
        Panel("makespan, s, mean", lines(lambda summary: summary.makespan)),
    ]


def legend_of(panels):
    """One line for each name, the first of that name."""
    legend = {}
    for panel in panels:
        for line in panel.lines:
            legend.setdefault(line.name, line)
    return list(legend.values())


def draw(panels, file):
    """Draws the panels side by side to an SVG file."""
    import matplotlib  # here, so that everything else works without it
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "fleetplan", "font.size": 9,
                                "axes.spines.top": False, "axes.spines.right": False})
    import matplotlib.pyplot

    figure, axes = matplotlib.pyplot.subplots(1, len(panels), sharex=True, figsize=(3.6 * len(panels), 4))
    for panel, axis in zip(panels, axes):
        for line in panel.lines:
            axis.plot(*zip(*line.points), **style(line))
        axis.set_title(panel.title, fontsize=9, fontweight="bold", loc="left")
        axis.set_xlabel("robots")
        axis.set_xlim(left=0)
        axis.grid(axis="y", color="#e3e3e3")
        if panel.logarithmic:
            axis.set_yscale("log")
        axis.yaxis.set_major_formatter("{x:g}")
        if panel.from_zero:
            axis.set_ylim(bottom=0)
    legend = legend_of(panels)
    handles = [matplotlib.lines.Line2D([], [], label=line.name, **style(line)) for line in legend]
    figure.suptitle(TITLE, x=0.01, ha="left", fontweight="bold")
    figure.legend(handles=handles, loc="lower left", frameon=False)
    figure.tight_layout(rect=(0, 0.06 * len(legend), 1, 1))
    figure.savefig(file, metadata={"Date": None, "Creator": None})


def style(line):
    return {"color": line.colour, "linestyle": "--" if line.dashed else "-", "marker": "" if line.dashed else ".",
            "linewidth": 1.5}
