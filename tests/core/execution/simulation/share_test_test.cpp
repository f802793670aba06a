#include "core/execution/simulation/share_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace fleetplan::core {
namespace TEST_FILE {

void expect_close(double value, double exact) {
  EXPECT_NEAR(value, exact, 1e-11 * exact) << "relative error " << value / exact - 1.0;
}

// The exact values are sums of fractions, and of decimals with 60 digits for many runs.
TEST(BinomialTails, AreExact) {
  expect_close(at_most(0, 775, 0.01), 0.00041426268253824645);
  expect_close(at_most(5, 50, 0.01), 0.9999891031679734);
  expect_close(at_least(5, 50, 0.01), 0.00014568926807182695);
  expect_close(at_most(3, 10, 0.5), 0.171875);
  expect_close(at_least(3, 10, 0.5), 0.9453125);
  expect_close(at_least(10, 10, 0.3), 5.9049e-06);
  expect_close(at_most(0, 1, 0.1), 0.9);
  expect_close(at_most(12, 400, 0.05), 0.0355059041776182);
  expect_close(at_least(12, 400, 0.05), 0.9809539692926107);
  expect_close(at_most(20, 2000, 0.01), 0.559093331998649);
  expect_close(at_least(20, 2000, 0.01), 0.5301894837340014);
  expect_close(at_most(0, 50, 0.5), 8.881784197001252e-16);
  expect_close(at_least(1, 3000, 1e-4), 0.2591928922491134);
  expect_close(at_most(25, 50, 0.5), 0.5561375863296085);
  expect_close(at_least(170, 200, 0.8), 0.04302155637566113);
  expect_close(at_most(150, 20'000, 0.01), 0.00012291973819237184);
  expect_close(at_most(4, 100'000, 1e-4), 0.029247013205559206);
  expect_close(at_least(1100, 100'000, 0.01), 0.0009117803412451066);
}

TEST(BinomialTails, AreCertainAtTheEnds) {
  EXPECT_EQ(at_least(0, 10, 0.2), 1.0);
  EXPECT_EQ(at_most(10, 10, 0.2), 1.0);
  EXPECT_EQ(at_least(11, 10, 0.2), 0.0);
}

TEST(BinomialTails, AddUpToOne) {
  for (const std::size_t runs : {1U, 7U, 50U, 800U, 20'000U}) {
    for (const double share : {1e-4, 0.01, 0.3, 0.5}) {
      for (std::size_t count = 1; count <= runs; count = 2 * count + 1) {
        EXPECT_NEAR(at_most(count - 1, runs, share) + at_least(count, runs, share), 1.0, 1e-11)
            << count << " of " << runs << " with " << share;
      }
    }
  }
}

TEST(ClopperPearson, HasTheExactEnds) {
  const auto expect = [](std::size_t count, std::size_t runs, double confidence, double low, double high) {
    const ShareInterval interval = clopper_pearson(count, runs, confidence);
    EXPECT_NEAR(interval.low, low, 1e-11);
    EXPECT_NEAR(interval.high, high, 1e-11);
  };
  expect(0, 50, 0.95, 0.0, 0.07112173646419766);
  expect(5, 50, 0.95, 0.033275093589022475, 0.21813536643420225);
  expect(50, 50, 0.95, 0.9288782635358024, 1.0);
  expect(3, 800, 0.99, 0.00042276865574568525, 0.013653599119112993);
  expect(1, 10, 0.9, 0.005116196891823701, 0.39416330243650477);
}

TEST(ShareTest, LooksTwiceAsLateEachTimeAndAtTheEnd) {
  const ShareTest test({0.01, 0.95}, 6, 20'000);
  std::vector<std::size_t> looks;
  for (std::size_t runs = 0; runs < 20'000;) looks.push_back(runs = test.next_look(runs));
  EXPECT_EQ(looks, (std::vector<std::size_t>{50, 100, 200, 400, 800, 1600, 3200, 6400, 12'800, 20'000}));
  EXPECT_EQ(ShareTest({0.01, 0.95}, 6, 100).next_look(50), 100U);
  EXPECT_EQ(ShareTest({0.5, 0.5}, 1, 50).next_look(0), 50U);
}

// e = 0.05 / (2 * 6 * 10): ln e / ln 0.99 = 774.4.
TEST(ShareTest, DecidesAtTheRunsOfItsError) {
  const ShareTest test({0.01, 0.95}, 6, 20'000);
  EXPECT_EQ(test.least_runs(), 775U);
  EXPECT_EQ(test.look(0, 774), ShareTest::Verdict::open);
  EXPECT_EQ(test.look(0, 775), ShareTest::Verdict::met);
  EXPECT_EQ(test.look(4, 50), ShareTest::Verdict::open);
  EXPECT_EQ(test.look(5, 50), ShareTest::Verdict::not_met);
}

/// How many of `tests` tests of coins with this share say that the aim is met.
int met_of(const ShareTest& test, std::size_t runs, double share, int tests) {
  std::mt19937_64 random(7);
  std::bernoulli_distribution coin(share);
  int met = 0;
  for (int k = 0; k < tests; ++k) {
    std::size_t bad = 0;
    auto verdict = ShareTest::Verdict::open;
    for (std::size_t done = 0; done < runs && verdict == ShareTest::Verdict::open;) {
      const std::size_t next = test.next_look(done);
      for (; done < next; ++done) bad += coin(random) ? 1 : 0;
      verdict = test.look(bad, done);
    }
    met += verdict == ShareTest::Verdict::met ? 1 : 0;
  }
  return met;
}

TEST(ShareTest, IsSeldomWrong) {
  constexpr int kTests = 4000;
  constexpr std::size_t kRuns = 1600;
  constexpr double kAim = 0.05;
  // All candidates together are wrong with a chance of 5 %, so each is with one of less than 2.5 % / 4.
  const ShareTest test({kAim, 0.95}, 4, kRuns);
  EXPECT_LE(met_of(test, kRuns, kAim * 1.001, kTests), kTests / 100);
  EXPECT_EQ(met_of(test, kRuns, kAim / 4.0, 200), 200);
  EXPECT_EQ(met_of(test, kRuns, kAim * 3.0, kTests), 0);
  // A planted fault, an error of 1/2 at each look, is found by the same check.
  constexpr double kCandidatesAndLooks = 4.0 * 6.0;
  const ShareTest planted({kAim, 1.0 - kCandidatesAndLooks}, 4, kRuns);
  EXPECT_GT(met_of(planted, kRuns, kAim * 1.001, kTests), kTests / 4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
