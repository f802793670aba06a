// Drives of robots whose acceleration is limited, against profiles and against what any drive has to obey.

#include "core/execution/drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// Translations along x, one after the other at speed, each with the fastest profile.
std::vector<Action> translations(const std::vector<LimitedPart>& parts, const Inertia& inertia) {
  const std::vector<SpeedProfile> profiles = fastest_profiles(parts, inertia);
  std::vector<Action> actions;
  double t = 0.0;
  double x = 0.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double seconds = duration(profiles[k], parts[k].length);
    actions.push_back(
        {Action::Type::translate, t, t + seconds, {{x, 0}, 0.0}, {{x + parts[k].length, 0}, 0.0}});
    actions.back().profile = profiles[k];
    t += seconds;
    x += parts[k].length;
  }
  return actions;
}

/// 18 m at 2 m/s: 2 s and 2 m to start, 4 s and 4 m to stop; 12 s in all.
const Inertia kHeavy{1.0, 2.0};
std::vector<Action> corridor() { return translations({{18.0, 2.0}}, kHeavy); }

double driven_until(Drive& drive) {
  drive.drive_to(drive.heading_for());
  return drive.now();
}

TEST(Drive, TakesThePlannedTime) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(18.0);
  EXPECT_DOUBLE_EQ(drive.time_at(2.0), 2.0);
  EXPECT_DOUBLE_EQ(drive.time_at(0.5), 1.0);
  EXPECT_DOUBLE_EQ(drive.time_at(14.0), 8.0);
  EXPECT_DOUBLE_EQ(driven_until(drive), 12.0);
}

TEST(Drive, StandsAtAPlaceAndGoesOnFromRest) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(9.0);
  EXPECT_DOUBLE_EQ(driven_until(drive), 9.0 / 2 + 1 + 2);
  EXPECT_EQ(drive.speed(), 0.0);
  drive.stand_until(10.0);
  drive.head_for(18.0);
  EXPECT_DOUBLE_EQ(driven_until(drive), 10 + 9.0 / 2 + 1 + 2);
}

TEST(Drive, LosesNothingIfItMayGoOnBeforeItBrakes) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(9.0);  // it brakes from 5 m and 3.5 s on
  drive.drive_until(3.4);
  EXPECT_FALSE(drive.slows_down());
  drive.head_for(18.0);
  EXPECT_NEAR(driven_until(drive), 12.0, 1e-12);
}

TEST(Drive, GoesOnFromTheSpeedThatItHas) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(9.0);
  drive.drive_until(5.5);  // it has braked for 2 s: 1 m/s at 8 m
  EXPECT_TRUE(drive.slows_down());
  EXPECT_DOUBLE_EQ(drive.at(), 8.0);
  EXPECT_DOUBLE_EQ(drive.speed(), 1.0);
  drive.head_for(18.0);
  // 1 s and 1.5 m to 2 m/s, 4 s and 4 m to stop, 4.5 m between.
  EXPECT_DOUBLE_EQ(driven_until(drive), 5.5 + 1.0 + 2.25 + 4.0);
}

TEST(Drive, HasFactorsOnItsCruiseSpeeds) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {0.5}, 0.0, 0.0);
  drive.head_for(18.0);
  EXPECT_DOUBLE_EQ(driven_until(drive), 18.0 / 1 + 0.5 + 1);
}

TEST(Drive, LeadsThroughActionsAtSpeed) {
  const std::vector<Action> actions = translations({{5, 2}, {5, 1}, {5, 2}}, kHeavy);
  EXPECT_EQ(end_of_drive(actions, 0), 3U);
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(15.0);
  const auto pieces = drive.drive_to(15.0);
  EXPECT_NEAR(drive.now(), actions.back().t_end, 1e-12);
  for (const DrivenPiece& piece : pieces) {
    EXPECT_LE(0.0, piece.from);
    EXPECT_LT(piece.from, piece.to);
    EXPECT_LE(piece.to, 1.0);
  }
  EXPECT_EQ(pieces.back().action, 2U);
  EXPECT_EQ(pieces.back().to, 1.0);
}

TEST(Drive, MayBeginAtSpeedInTheMiddle) {
  const std::vector<Action> actions = corridor();
  Drive drive(actions, 0, {1.0}, 6.0, 2.0, 10.0 / 18.0);
  drive.head_for(18.0);
  EXPECT_NEAR(driven_until(drive), 12.0, 1e-12);
}

TEST(Drive, OfARobotWithoutLimitsIsAtConstantSpeed) {
  std::vector<Action> actions = translations({{6.0, 2.0}}, {});
  Drive drive(actions, 0, {1.0}, 0.0, 0.0);
  drive.head_for(3.0);
  EXPECT_DOUBLE_EQ(drive.time_at(1.0), 0.5);
  EXPECT_DOUBLE_EQ(driven_until(drive), 1.5);
}

/// Whatever opens and closes on its way, a robot goes on where it is with the speed that it has, within its
/// limits.
TEST(Drive, ObeysItsLimitsWhereverItIsHeadedFor) {
  support::Dice dice(20261127);
  for (int run = 0; run < 2000; ++run) {
    SCOPED_TRACE(testing::Message() << "run " << run);
    const Inertia inertia{1.0 / std::pow(10.0, dice.between(-1, 1)),
                          1.0 / std::pow(10.0, dice.between(-1, 1))};
    std::vector<LimitedPart> parts;
    for (int k = 1 + dice.below(3); k > 0; --k) parts.push_back({dice.between(0.1, 8), dice.between(0.3, 2)});
    const std::vector<Action> actions = translations(parts, inertia);
    const double factor = dice.chance(0.5) ? 1.0 : dice.between(0.3, 1.0);
    Drive drive(actions, 0, {factor}, 0.0, 0.0);
    std::vector<DrivenPiece> driven;
    const auto note = [&](const std::vector<DrivenPiece>& pieces) {
      driven.insert(driven.end(), pieces.begin(), pieces.end());
    };
    while (drive.at() < drive.length()) {
      const double braking = 0.5 * drive.speed() * drive.speed() * inertia.fall;
      const double least = std::min(drive.length(), drive.at() + braking + 1e-9);
      drive.head_for(dice.chance(0.4) ? drive.length() : dice.between(least, drive.length()));
      if (dice.chance(0.5)) {
        note(drive.drive_to(drive.heading_for()));
        ASSERT_NEAR(drive.speed(), 0.0, 1e-12);
        drive.stand_until(drive.now() + 1.0);
      } else {
        note(drive.drive_until(drive.now() + dice.between(0.0, 3.0)));
      }
    }
    double x = 0.0;
    double t = 0.0;
    double speed = 0.0;
    for (const DrivenPiece& piece : driven) {
      const double length = parts[piece.action].length;
      const double begin = actions[piece.action].from.position.x();
      const double seconds = piece.t_end - piece.t_start;
      if (seconds <= 1e-9) continue;  // rounding
      const double mean = (piece.to - piece.from) * length / seconds;
      const double start = mean * (1.0 - piece.ramp);
      const double end = mean * (1.0 + piece.ramp);
      ASSERT_NEAR(begin + piece.from * length, x, 1e-9);
      if (piece.t_start - t < 0.5) {
        ASSERT_NEAR(start, speed, 1e-6);
      }
      const double inverse = end > start ? inertia.rise : inertia.fall;
      ASSERT_LE(std::abs(end - start) * inverse, seconds * (1.0 + 1e-6) + 1e-9);
      ASSERT_LE(std::max(start, end), factor * parts[piece.action].limit + 1e-6);
      x = begin + piece.to * length;
      t = piece.t_end;
      speed = end;
    }
    EXPECT_NEAR(speed, 0.0, 1e-6);
    EXPECT_NEAR(x, actions.back().to.position.x(), 1e-9);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
