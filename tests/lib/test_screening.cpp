// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The second stage of the pairing: which instants are believed, in chains that no motion spans.
#include <gtest/gtest.h>

#include "../support/pairing_stages.hpp"
#include "../support/random_motion.hpp"
#include "egocal/pairing/motion_pairing.hpp"

namespace egocal::test_screening {
namespace {

using testing::displacement;
using testing::instants_of;
using testing::period_us;
using testing::Random;
using testing::rejected;
using testing::simulated;
using testing::Streams;

TEST(Screening, RejectsGlitchesAndBeginsAChainWhereTrackingJumped) {
  Streams data = simulated(400);
  for (const std::size_t i : {100u, 151u, 202u})
    data.b[i].pose = normalized(data.b[i].pose * displacement({0.5, 0.2, 0}, {2, 0, 0}));
  const DualQuaternion jump = displacement({0.4, 0.3, 1}, {3, -2, 1});
  for (std::size_t i = 300; i < data.b.size(); ++i) data.b[i].pose = normalized(jump * data.b[i].pose);
  Screening screening{ScreeningOptions{}};
  std::vector<Instant> accepted;
  for (const Instant& instant : instants_of(data)) {
    const Screened screened = screening.push(instant, period_us);
    if (screened.replaces) accepted.clear();
    accepted.insert(accepted.end(), screened.accepted.begin(), screened.accepted.end());
  }
  screening.finish();
  EXPECT_EQ(rejected(screening.state().rejections, Rejection::screw_congruence), 4u);
  EXPECT_EQ(accepted.size(), 397u);  // the jump itself is counted, and costs no instant
  for (const Instant& instant : accepted) {
    EXPECT_NE(instant.number, 101u);
    EXPECT_EQ(instant.chain, instant.time_us >= data.a[300].time_us ? 1u : 0u);
  }
}

TEST(Screening, DoesNotCompareAcrossClocks) {
  Streams data = simulated(200);
  const DualQuaternion jump = displacement({0.4, 0.3, 1}, {3, -2, 1});
  for (std::size_t i = 100; i < data.b.size(); ++i) data.b[i].pose = normalized(jump * data.b[i].pose);
  std::vector<Instant> instants = instants_of(data);
  for (std::size_t i = 100; i < instants.size(); ++i) instants[i].chain = 1;
  Screening screening{ScreeningOptions{}};
  std::size_t accepted = 0;
  for (const Instant& instant : instants) {
    const Screened screened = screening.push(instant, period_us);
    accepted = screened.accepted.size() + (screened.replaces ? 0 : accepted);
  }
  screening.finish();
  EXPECT_EQ(accepted, 200u);
  EXPECT_EQ(rejected(screening.state().rejections, Rejection::screw_congruence), 0u);
}

/// The tip of a crane's boom is 60 m from its cabin, and the boom nods: lengths differ by metres a second.
TEST(Screening, LongLeverArmsAreAnOption) {
  const DualQuaternion T = displacement({0.1, 0.2, 0.3}, {60, 3, 5});
  Random random(3);
  std::vector<Instant> instants;
  DualQuaternion a;
  for (std::uint64_t i = 0; i < 600; ++i) {
    // still for a while, then turning
    const double turn = i % 100 < 50 ? 0.0005 : 0.05;
    a = normalized(a * testing::random_displacement(random, turn, 0.02));
    const DualQuaternion noise = testing::normal_displacement(random, 1e-5, 1e-3);
    instants.push_back({static_cast<std::int64_t>(i) * period_us, a, normalized(a * T * noise), 0, i + 1});
  }
  const auto rejections = [&](double longest_lever_arm) {
    Screening screening{ScreeningOptions{.congruence = {.longest_lever_arm = longest_lever_arm}}};
    for (const Instant& instant : instants) screening.push(instant, period_us);
    screening.finish();
    return rejected(screening.state().rejections, Rejection::screw_congruence);
  };
  EXPECT_GT(rejections(10), 0u);
  EXPECT_EQ(rejections(100), 0u);
}

}  // namespace
}  // namespace egocal::test_screening
