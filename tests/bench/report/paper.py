"""The protocol and the claims of the paper (Yakovlev, Andreychuk and Vorobyev, ECMR 2019, Simulated experiments)."""

# The numbers of robots in the paper's protocol.
ROBOTS = range(15, 301, 15)
SEEDS = range(1, 101)

# The paper's planner solved every instance of the empty hall with up to ALL_SOLVED_UP_TO robots. With FEW_SOLVED_FROM
# robots or more, it solved less than FEW_SOLVED of them.
ALL_SOLVED_UP_TO = 210
FEW_SOLVED_FROM = 285
FEW_SOLVED = 0.1

# Its charts show more, but no numbers that could be quoted.
CLAIMS = """\
The paper's claims (ECMR 2019, 100 meta-instances, limit 60 s):
- empty: AA-SIPP(m) solved all instances with up to 210 robots, almost always had to re-schedule above 240
  robots, and solved less than 10 % with 285 or 300. ORCA failed some already with 45 robots and solved about
  50-60 % with 285 or 300. ORCA's flowtime was 10-15 % worse with few robots and more than 50 % with 150, its
  makespan about 4 % worse on average.
- rects: ORCA did not solve all even with 15 robots; above 60 robots its flowtime was up to about 2 times
  and its makespan up to almost 40 % above AA-SIPP(m)'s.
- Runtimes are only in its charts; ORCA's were lower than AA-SIPP(m)'s.
"""


def claimed_success(hall, robots):
    """The success rate that the text states for a hall and a number of robots."""
    if hall != "empty":
        return "-"
    if robots <= ALL_SOLVED_UP_TO:
        return "100 %"
    return "< 10 %" if robots >= FEW_SOLVED_FROM else "-"
