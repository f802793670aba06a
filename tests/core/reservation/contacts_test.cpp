#include "core/reservation/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/tolerance.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"
#include "tests/core/support/disks.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Robots = std::vector<std::size_t>;

constexpr double kRadius = 0.25;  // metres, of all robots
constexpr double kInflation = 0.25;

Terminals at(double x, double y, std::optional<Position> goal = std::nullopt) {
  return {{x, y}, goal, kRadius + kInflation, 0.0, 0.0, kInflation, kRadius, kRadius};
}
Terminals at(double x, double y, double goal_x, double goal_y) { return at(x, y, Position(goal_x, goal_y)); }

Segment rest(double x, double y) { return {{x, y}, {x, y}}; }
SizedSegment motion(const Segment& path, double t_start, double t_end) {
  return {{path, t_start, t_end}, kRadius};
}
std::vector<SizedSegment> resting(double x, double y) { return {motion(rest(x, y), 0.0, kForever)}; }

TEST(Contacts, AreNoneWhereRobotsKeepTheirDistance) {
  const Contacts contacts({at(1, 1, 5, 1), at(2, 1, 6, 1), at(2, 2)});
  EXPECT_TRUE(contacts.empty()) << "touching is not too near";
  EXPECT_EQ(contacts.terminal(0, rest(1, 1), kRadius), Terminal::none) << "nothing to look up";
}

TEST(Contacts, KeepTheDistanceOfTheStartsWhileBothLeave) {
  const Contacts contacts({at(1, 1, 5, 1), at(1.75, 1), at(3, 3)});
  EXPECT_EQ(contacts.at_start(0), Robots{1});
  EXPECT_EQ(contacts.at_start(1), Robots{0});
  EXPECT_TRUE(contacts.none(2));
  EXPECT_NEAR(contacts.deficit(0), 0.25, 1e-12);
  EXPECT_EQ(contacts.terminal(0, {{1, 1}, {1, 2}}, kRadius), Terminal::start);
  EXPECT_EQ(contacts.terminal(0, {{1, 2}, {1, 1}}, kRadius), Terminal::none)
      << "only moves from the start leave";
  EXPECT_NEAR(contacts.distance(0, Terminal::start, 1, Terminal::start, 1.0), 0.75, 1e-12);
  EXPECT_LT(contacts.distance(0, Terminal::start, 1, Terminal::start, 1.0), 0.75) << "it may stay";
  EXPECT_EQ(contacts.distance(0, Terminal::none, 1, Terminal::start, 1.0), 1.0);
  EXPECT_EQ(contacts.distance(0, Terminal::goal, 1, Terminal::start, 1.0), 1.0);
  EXPECT_EQ(contacts.distance(0, Terminal::start, 2, Terminal::start, 1.0), 1.0);
}

TEST(Contacts, OfBareDisksAreLeftOneAfterTheOther) {
  const Contacts contacts({at(1, 1), at(1.4, 1)});  // nearer than without inflation
  EXPECT_EQ(contacts.terminal(0, rest(1, 1), kRadius), Terminal::start);
  EXPECT_EQ(contacts.terminal(0, {{1, 1}, {1, 2}}, kRadius), Terminal::leaving);
  EXPECT_NEAR(contacts.distance(0, Terminal::leaving, 1, Terminal::start, 1.0), 0.4, 1e-12);
  EXPECT_NEAR(contacts.distance(0, Terminal::start, 1, Terminal::leaving, 1.0), 0.4, 1e-12);
  EXPECT_EQ(contacts.distance(0, Terminal::leaving, 1, Terminal::leaving, 1.0), 1.0);
}

TEST(Contacts, DoNotDependOnTheRoundingOfSquares) {
  for (int k = 0; k < 1000; ++k) {  // starts as near as the search keeps robots apart
    const double angle = 0.1 + 0.006 * k;
    const double distance = 1.0 - kSearchSlack;
    const Position other(3 + distance * std::cos(angle), 3 + distance * std::sin(angle));
    const Contacts contacts({at(3, 3, 5, 1), at(other.x(), other.y())});
    ReservationTable table(10.0, 10.0, 1.0, disks_of({kRadius, kRadius}, kInflation), &contacts);
    table.reserve(1, resting(other.x(), other.y()));
    const Position away(3 - std::cos(angle), 3 - std::sin(angle));
    ASSERT_EQ(table.safe_intervals({0, kRadius}, {3, 3}).size(), 1u) << angle;
    ASSERT_EQ(table.earliest_departure({0, kRadius}, {{3, 3}, away}, 1.0, 0.0, kForever), 0.0) << angle;
  }
}

TEST(Contacts, AtGoalsAllowForContactOnly) {
  const Contacts contacts({at(1, 1, 5, 1), at(1, 3, 6 - 4e-7, 1), at(1, 5, 5, 1.9), at(4 + 4e-7, 1)});
  EXPECT_EQ(contacts.terminal(0, {{3, 1}, {5, 1}}, kRadius), Terminal::goal);
  EXPECT_NEAR(contacts.distance(0, Terminal::goal, 1, Terminal::goal, 1.0), 1.0 - 4e-7, 1e-12);
  EXPECT_EQ(contacts.distance(0, Terminal::goal, 2, Terminal::goal, 1.0), 1.0) << "not just contact";
  EXPECT_NEAR(contacts.distance(0, Terminal::goal, 3, Terminal::start, 1.0), 1.0 - 4e-7, 1e-12);
}

TEST(Contacts, AreThoseOfTheRadiiThatARobotBeginsAndEndsWith) {
  Terminals grows = at(1, 1, 5, 1);
  grows.radius_at_goal = 0.5;
  const Contacts contacts({grows, at(1.75, 1), at(6.1, 1)});
  EXPECT_EQ(contacts.terminal(0, rest(1, 1), kRadius), Terminal::start);
  EXPECT_EQ(contacts.terminal(0, rest(1, 1), 0.5), Terminal::none);
  EXPECT_EQ(contacts.terminal(0, rest(5, 1), 0.5), Terminal::goal);
  EXPECT_EQ(contacts.terminal(0, rest(5, 1), kRadius), Terminal::none);
}

TEST(Contacts, AreLimitedInNumberButSeenFromBothSides) {
  std::vector<Terminals> robots{at(5, 5)};
  for (int k = 0; k < 100; ++k) {
    const double angle = k * std::numbers::pi / 50.0;
    Terminals small = at(5 + 0.5 * std::cos(angle), 5 + 0.5 * std::sin(angle));
    small.pair_radius = 0.01;
    robots.push_back(small);
  }
  const Contacts contacts(robots);
  EXPECT_TRUE(contacts.too_many(0));
  EXPECT_EQ(contacts.at_start(0).size(), Contacts::kMaxContacts);
  for (std::size_t k = 1; k <= 100; ++k) {
    EXPECT_FALSE(contacts.too_many(k));
    EXPECT_NEAR(contacts.distance(0, Terminal::start, k, Terminal::start, 0.51), 0.5, 1e-12);
  }
}

/// Two robots of radius 0.5 m, inflation included, that start 0.75 m apart; robot 1 stands there.
class TooNear : public testing::Test {
 protected:
  TooNear()
      : contacts({at(2, 2, 6, 2), at(2.75, 2)}),
        table(10.0, 10.0, 1.0, disks_of({kRadius, kRadius}, kInflation), &contacts) {
    table.reserve(1, resting(2.75, 2));
  }
  std::optional<double> departure(const Position& from, const Position& to) const {
    return table.earliest_departure({0, kRadius}, {from, to}, 1.0, 0.0, kForever);
  }

  Contacts contacts;
  ReservationTable table;
};

TEST_F(TooNear, TheStartIsSafe) {
  ASSERT_EQ(table.safe_intervals({0, kRadius}, {2, 2}).size(), 1u);
  EXPECT_TRUE(table.safe_intervals({0, kRadius}, {2.05, 2}).empty()) << "it may not stop elsewhere so near";
  EXPECT_TRUE(table.robots_hit(0, resting(2, 2)).empty());
}

TEST_F(TooNear, AMoveMayLeadAwayButNotNearer) {
  EXPECT_EQ(departure({2, 2}, {1, 2}), 0.0);
  EXPECT_EQ(departure({2, 2}, {2, 3}), 0.0) << "across";
  EXPECT_FALSE(departure({2, 2}, {3, 2.2}));
  EXPECT_FALSE(departure({2, 2}, {2.1, 3})) << "a little nearer at first";
  EXPECT_FALSE(departure({1, 2}, {2, 2})) << "back";
}

TEST_F(TooNear, ARobotThatHasLeftMayNotBeSoNearAgain) {
  const Footprint back{0, kRadius, true};
  EXPECT_TRUE(table.safe_intervals(back, {2, 2}).empty());
  EXPECT_FALSE(table.earliest_departure(back, {{2, 2}, {1, 2}}, 1.0, 0.0, kForever));
  const SizedSegment leaves = motion({{2, 2}, {1, 2}}, 0.0, 1.0);
  const SizedSegment leaves_again = motion({{2, 2}, {1, 2}}, 2.0, 3.0);
  const SizedSegment elsewhere = motion({{1, 2}, {1, 9}}, 1.0, 2.0);
  EXPECT_TRUE(table.robots_hit(0, {leaves, elsewhere}).empty());
  EXPECT_EQ(table.robots_hit(0, {leaves, elsewhere, leaves_again}), Robots{1});
  table.remove(1);
  table.reserve(0, {leaves, elsewhere, leaves_again});
  const SizedSegment stays = motion(rest(2.75, 2), 0.0, 1.5);
  EXPECT_TRUE(table.robots_hit(1, {stays}).empty());
  EXPECT_EQ(table.robots_hit(1, {stays, motion({{2.75, 2}, {3.75, 2}}, 2.0, 3.0)}), Robots{0});
}

TEST_F(TooNear, BothMayLeaveAtOnce) {
  table.remove(1);
  table.reserve(1, {motion({{2.75, 2}, {4.75, 2}}, 0.0, 2.0), motion(rest(4.75, 2), 2.0, kForever)});
  EXPECT_EQ(departure({2, 2}, {3, 2}), 0.0) << "behind the other one, at its speed";
  EXPECT_TRUE(table.robots_hit(0, {motion({{2, 2}, {3, 2}}, 0.0, 1.0)}).empty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
