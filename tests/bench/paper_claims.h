#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fleetplan::bench {

/// What the paper's text says of its AA-SIPP(m) (Yakovlev, Andreychuk and Vorobyev, ECMR 2019, Simulated
/// experiments; a limit of 60 s, 100 meta-instances). Its charts hold more, but no numbers that could be
/// quoted.
inline constexpr std::string_view kPaperClaims =
    "What the paper says (ECMR 2019, 100 meta-instances, limit 60 s):\n"
    "- empty: AA-SIPP(m) solved all instances with up to 210 robots, almost always had to re-schedule above "
    "240\n"
    "  robots, and solved less than 10 % with 285 or 300. ORCA failed some already with 45 robots and solved "
    "about\n"
    "  50-60 % with 285 or 300. ORCA's flowtime was 10-15 % worse with few robots and more than 50 % with "
    "150, its\n"
    "  makespan about 4 % worse on average.\n"
    "- rects: ORCA did not solve all even with 15 robots; above 60 robots its flowtime was up to about 2 "
    "times\n"
    "  and its makespan up to almost 40 % above AA-SIPP(m)'s.\n"
    "- Runtimes are only in its charts; ORCA's were lower than AA-SIPP(m)'s.\n";

/// The success rate that the text gives for a hall ("empty" or "rects") and a number of robots.
std::string claimed_success(std::string_view hall, std::size_t robots);

/// The numbers of robots that the paper goes through, and the step between them.
inline constexpr std::size_t kFewestRobots = 15;
inline constexpr std::size_t kMostRobots = 300;
inline constexpr std::size_t kRobotsStep = 15;

/// Up to so many robots the paper's planner solved every instance of the empty hall, and from so many on less
/// than kFewSolved of them.
inline constexpr std::size_t kAllSolvedUpTo = 210;
inline constexpr std::size_t kFewSolvedFrom = 285;
inline constexpr double kFewSolved = 0.1;

}  // namespace fleetplan::bench
