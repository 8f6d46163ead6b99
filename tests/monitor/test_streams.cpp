// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The sensors' streams on the screens, and the reasons for which processes reject.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "egocal/monitor/layout.hpp"
#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/view.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_streams {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Severity_ = bus::StreamLine::Severity;

constexpr Now some_time{1'000'000, 1'600'000'100'000'000};

class Streams : public ::testing::Test {
 protected:
  std::string shown(Screen screen, int w, int h) {
    view.screen = screen;
    Canvas canvas(w, h);
    draw(canvas, model, view);
    return canvas.to_text();
  }
  Model model;
  ViewState view;
};

const std::string silent_line = "camera: ODOMETRY_CAMERA, nothing received; received instead: ODOMETRY_CAM";

TEST_F(Streams, AFirstScreenSaysWhichSensorIsMissed) {
  model.expect_pair("lidar", "camera");
  model.set_streams({{Severity_::good, "lidar: ODOMETRY_LIDAR, 10 Hz"}, {Severity_::bad, silent_line}});
  for (const auto& [w, h] : {std::pair{80, 24}, {120, 40}})
    EXPECT_THAT(shown(Screen::overview, w, h), HasSubstr(silent_line));
  EXPECT_THAT(text_lines(model, Charset::ascii), HasSubstr("stream " + silent_line));
  model.set_streams({{Severity_::good, "lidar: ODOMETRY_LIDAR, 10 Hz"}});
  EXPECT_THAT(shown(Screen::overview, 80, 24), Not(HasSubstr("Streams"))) << "nothing is wrong";
  EXPECT_THAT(shown(Screen::streams, 80, 24), HasSubstr("lidar: ODOMETRY_LIDAR, 10 Hz"));
}

TEST_F(Streams, TheirOwnScreenHasRoomForWholeSentences) {
  model.set_streams({{Severity_::warning,
                      "camera: ODOMETRY_CAMERA, egocal.odometry_t, 10 Hz, 145 messages, 1 of "
                      "them with faults"},
                     {Severity_::warning,
                      "  1 x clock jumps: its time jumped ahead by 3600 s: was the clock of the "
                      "sender set? Set it before the sensor sends."}});
  for (const int w : {40, 60, 80, 110}) {
    const std::string text = shown(Screen::streams, w, 24);
    EXPECT_THAT(text, HasSubstr("with faults")) << w;
    EXPECT_THAT(text, HasSubstr("sensor sends.")) << w;
    EXPECT_THAT(text, Not(HasSubstr("~"))) << w;
  }
  EXPECT_THAT(shown(Screen::overview, 80, 24), HasSubstr("~")) << "a row each";
  // the end can be reached where it is below the screen
  view.screen = Screen::streams;
  view.width = 40;
  view.height = 6;
  for (int i = 0; i < 20; ++i) press(view, model, {Key::down});
  EXPECT_THAT(shown(Screen::streams, 40, 6), HasSubstr("sensor sends."));
}

TEST_F(Streams, NeverOverlapTheRestAtAnySize) {
  for (int w = 1; w < 130; w += 3)
    for (int h = 1; h < 50; ++h)
      for (const int streams : {0, 1, 3, 40}) {
        const OverviewLayout o = layout_overview(w, h, 2, 6, streams);
        const Rect all[] = {o.header, o.pairs, o.summary, o.streams, o.processes, o.events, o.keys};
        for (const Rect& rect : all) {
          if (rect.empty()) continue;
          ASSERT_TRUE(rect.x >= 0 && rect.y >= 0 && rect.x + rect.w <= w && rect.y + rect.h <= h);
          for (const Rect& other : all)
            if (&other != &rect && !other.empty()) {
              ASSERT_TRUE(intersection(rect, other).empty()) << w << "x" << h;
            }
        }
        ASSERT_FALSE(o.pairs.empty());
      }
}

TEST_F(Streams, TheFirstRejectionOfEachKindIsAnEventWithItsCure) {
  status_t status = test::status_of("egocal-pairing", "pairing", 100);
  const auto reject = [&](const std::string& reason, std::int64_t count) {
    counter_t& counter = status.counters.emplace_back();
    counter.name = "rejected: " + reason;
    counter.value = count;
    status.n_counters = static_cast<std::int32_t>(status.counters.size());
  };
  reject("gap", 0);
  reject("screw congruence", 3);
  model.on_status(status, some_time);
  status.counters.back().value = 9;
  model.on_status(status, some_time);
  int events = 0;
  for (const Event& event : model.events())
    if (event.text.starts_with("rejects: ")) {
      ++events;
      EXPECT_THAT(event.text, HasSubstr("screw congruence: motions of the two sensors differ"));
    }
  EXPECT_EQ(events, 1);
  EXPECT_THAT(shown(Screen::streams, 120, 24), HasSubstr("egocal-pairing rejected 9 x screw congruence: "));
  for (int i = 0; i < 1000; ++i) reject("flood " + std::to_string(i), 1);
  model.on_status(status, some_time);
  EXPECT_LE(model.processes()[0].rejections.size(), 64u);
}

TEST_F(Streams, TheGapPanelIsAboutTheFastSolution) {
  const problem_t problem = test::problem_at("lidar", "camera", 100, 10);
  model.on_problem(problem, some_time);
  model.on_calibration(test::calibration_at(problem, true), some_time);
  EXPECT_THAT(shown(Screen::detail, 140, 42), HasSubstr("scaled gap of the global solution (limit 1)"));
  model.on_calibration(test::calibration_at(problem, false), some_time);
  EXPECT_THAT(shown(Screen::detail, 140, 42), HasSubstr("scaled gap of the fast solution (limit 1)"));
  // while the fast process solves globally itself, its own solution is not known
  calibration_t answer = test::calibration_at(test::problem_at("lidar", "camera", 110, 10), false);
  answer.method = "dual";
  model.on_calibration(answer, some_time);
  const SolverTrack& fast = model.pairs()[0].solvers.back();
  ASSERT_EQ(fast.role, Role::fast);
  const Slice& last = fast.history.since(0).back();
  EXPECT_FALSE(std::isfinite(last.low[scaled_gap]));
  EXPECT_TRUE(std::isfinite(last.low[execution_time]));
}

}  // namespace
}  // namespace egocal::monitor::test_streams
