// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What a newcomer reads about a sensor that is silent, on another channel, or sends what cannot be used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/stream_watch.hpp"

namespace egocal::bus::test_stream_watch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t start_us = 1'600'000'000'000'000;

class Watch : public ::testing::Test {
 protected:
  Watch()
      : watch({{"lidar", "ODOMETRY_LIDAR", OdometryType::odometry, {}},
               {"camera", "ODOMETRY_CAMERA", OdometryType::odometry, {}}}) {}

  template <class Message>
  std::optional<Refusal> hear(const std::string& channel, const Message& message, std::int64_t mono_us) {
    return watch.hear(channel, encode(message), mono_us);
  }
  /// Good poses at a rate; their times are multiplied.
  void play(const std::string& channel, double hz, double seconds, double time_factor = 1) {
    for (int i = 0; i < hz * seconds; ++i) {
      const double t = 1e6 * i / hz;
      odometry_t message = to_message(StampedPose{start_us, {}}, i);
      message.utime = start_us + std::llround(time_factor * t);
      hear(channel, message, 5'000'000 + std::llround(t));
    }
  }
  std::string said(std::int64_t mono_us) const {
    std::string text;
    for (const StreamLine& line : stream_lines(watch, mono_us)) text += line.text + "\n";
    return text;
  }

  StreamWatch watch;
};

TEST_F(Watch, WhatIsWellHasTypeAndRate) {
  play("ODOMETRY_LIDAR", 10, 6);
  play("ODOMETRY_CAMERA", 33, 6);
  EXPECT_THAT(said(11'000'000), HasSubstr("lidar: ODOMETRY_LIDAR, egocal.odometry_t, 10 Hz, 60 messages"));
  EXPECT_THAT(said(11'000'000), HasSubstr("camera: ODOMETRY_CAMERA, egocal.odometry_t, 33 Hz"));
  EXPECT_FALSE(watch.misses_any(11'000'000));
  for (const StreamLine& line : stream_lines(watch, 11'000'000))
    EXPECT_EQ(line.severity, StreamLine::Severity::good);
}

TEST_F(Watch, ASilentSensorComesWithWhatIsHeardInstead) {
  play("ODOMETRY_LIDAR", 10, 6);
  play("ODOMETRY_CAM", 33, 6);
  watch.hear("IMAGES", std::vector<std::byte>(100), 10'900'000);
  EXPECT_TRUE(watch.misses_any(11'000'000));
  EXPECT_THAT(said(11'000'000), HasSubstr("camera: ODOMETRY_CAMERA, nothing received; received instead: "
                                          "ODOMETRY_CAM (egocal.odometry_t, 33 Hz), IMAGES (unknown type)"));
  EXPECT_THAT(said(20'000'000), HasSubstr("lidar: ODOMETRY_LIDAR, silent for 9 s; no other channel"));
  const std::vector<StreamLine> paused = stream_lines(watch, 20'000'000, "the player is paused");
  ASSERT_EQ(paused.size(), 2u);
  EXPECT_EQ(paused[0].text, "lidar: ODOMETRY_LIDAR, silent for 9 s: the player is paused");
  EXPECT_EQ(paused[0].severity, StreamLine::Severity::good);
  EXPECT_THAT(paused[1].text, HasSubstr("nothing received")) << "it never came, whatever the player does";
  EXPECT_EQ(paused[1].severity, StreamLine::Severity::bad);

  const StreamWatch new_watch({{"lidar", "ODOMETRY_LIDAR", OdometryType::odometry, {}},
                               {"camera", "ODOMETRY_CAMERA", OdometryType::odometry, {}}});
  for (const StreamLine& line : stream_lines(new_watch, 20'000'000, "the player is paused")) {
    EXPECT_THAT(line.text, HasSubstr("nothing received: the player is paused"))
        << "one that came in the pause";
    EXPECT_EQ(line.severity, StreamLine::Severity::good);
  }
}

TEST_F(Watch, WhyAPairHasNoNewMotion) {
  EXPECT_EQ(why_no_motion(watch, "lidar", "camera", 11'000'000), "") << "nothing is known";
  play("ODOMETRY_LIDAR", 10, 6);
  EXPECT_EQ(why_no_motion(watch, "lidar", "camera", 11'000'000), "camera sends nothing");
  play("ODOMETRY_CAMERA", 33, 6);
  EXPECT_THAT(why_no_motion(watch, "lidar", "camera", 11'000'000), HasSubstr("pairing rejects the poses"));
  odometry_t message = to_message(StampedPose{start_us + 3'606'000'000, {}}, 198);
  hear("ODOMETRY_CAMERA", message, 11'000'000);
  EXPECT_THAT(why_no_motion(watch, "lidar", "camera", 11'000'000),
              HasSubstr("do not overlap: those of camera are 3600.0 s ahead"));
  EXPECT_EQ(why_no_motion(watch, "lidar", "camera", 20'000'000), "") << "both are silent";
}

TEST_F(Watch, EveryFaultComesWithItsCureAndIsReportedOnce) {
  const auto refused = [&](const char* reason, const char* cure, auto change) {
    odometry_t message = to_message(StampedPose{start_us, {}}, 1);
    change(message);
    const std::optional<Refusal> first = hear("ODOMETRY_CAMERA", message, 6'000'000);
    ASSERT_TRUE(first) << reason;
    EXPECT_EQ(first->reason, reason);
    EXPECT_THAT(first->cure, HasSubstr(cure));
    EXPECT_FALSE(hear("ODOMETRY_CAMERA", message, 6'000'100)) << "an event for the first one only";
    EXPECT_THAT(said(6'000'200), HasSubstr("2 x " + first->reason + ": " + first->cure));
  };
  refused("time out of range", "times 1.49e+18 us: nanoseconds?",
          [](odometry_t& m) { m.utime = 1'490'000'000'000'000'000; });
  refused("quaternion not of unit length", "0 0 0 0: the field is not filled", [](odometry_t& m) {
    for (double& q : m.quat) q = 0;
  });
  refused("position not finite", "NaN", [](odometry_t& m) { m.pos[0] = std::nan(""); });
  refused("sequence number out of range", "-1 where", [](odometry_t& m) { m.seq = -7; });
  refused("covariance of the wrong size", "36, or 0", [](odometry_t& m) {
    m.covariance_size = 1;
    m.covariance = {1};
  });
  EXPECT_EQ(watch.sensors()[1].heard->refusals.size(), 5u);
}

TEST_F(Watch, AnotherTypeIsNamedWithTheLineForTheRig) {
  const std::optional<Refusal> first =
      hear("ODOMETRY_CAMERA", to_pose_message(StampedPose{start_us, {}}), 6'000'000);
  ASSERT_TRUE(first);
  EXPECT_THAT(first->cure, HasSubstr("it carries bot_core.pose_t"));
  EXPECT_THAT(first->cure, HasSubstr("set type = \"bot_core.pose_t\""));
}

TEST_F(Watch, TimesInAnotherUnitThatAreNoDateYetAreSeenByTheirPace) {
  for (const auto& [factor, unit] :
       {std::pair{1e-3, "milliseconds"}, {1e-6, "seconds"}, {1e3, "nanoseconds"}}) {
    StreamWatch fresh({{"lidar", "ODOMETRY_LIDAR", OdometryType::odometry, {}}});
    watch = fresh;
    // faster than a pose a second of its own time, or the times would be the same
    play("ODOMETRY_LIDAR", 10, 10, factor);
    EXPECT_THAT(said(15'000'000), HasSubstr(factor == 1e-6 ? "the same time again" : unit)) << factor;
  }
  StreamWatch fresh({{"lidar", "ODOMETRY_LIDAR", OdometryType::odometry, {}}});
  for (const double replay : {1.0, 0.5, 10.0, 100.0}) {
    watch = fresh;
    play("ODOMETRY_LIDAR", 10, 10, replay);
    EXPECT_THAT(said(15'000'000), Not(HasSubstr("unit of time"))) << "a replay at another speed";
  }
}

TEST_F(Watch, IsBoundedWhateverArrives) {
  for (int i = 0; i < 10'000; ++i)
    watch.hear("FLOOD_" + std::to_string(i), std::vector<std::byte>(10), 1000 + i);
  EXPECT_EQ(watch.others().size(), watch.options().most_others);
  EXPECT_LT(stream_lines(watch, 11'000).size(), 5u);
}

TEST_F(Watch, ItsOwnChannelsAreNoOdometry) {
  watch.hear("EGOCAL_STATUS", std::vector<std::byte>(10), 1000);
  EXPECT_TRUE(watch.others().empty());
}

}  // namespace
}  // namespace egocal::bus::test_stream_watch
