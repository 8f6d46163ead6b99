// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Everything that a sender can do wrong: nothing of it reaches the screen, memory stays bounded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "egocal/monitor/lines.hpp"
#include "egocal/monitor/model.hpp"
#include "egocal/monitor/view.hpp"
#include "pair_drive.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_hostile {
namespace {

using test::calibration_at;
using test::PairDrive;
using test::problem_at;
using test::status_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t largest_int = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t smallest_int = std::numeric_limits<std::int64_t>::min();

const std::string evil_text =
    "\x1b[2J\x1b]0;x\x07\r\n\t\xff\xfe\xc0\xaf\xf5\xed\xa0\x80" + std::string(200, 'W');

void expect_clean_screens(const Model& model) {
  for (const Charset charset : {Charset::ascii, Charset::unicode})
    for (const Screen screen : {Screen::overview, Screen::detail, Screen::events})
      for (const Dialog dialog : {Dialog::none, Dialog::help, Dialog::reset, Dialog::export_format})
        for (int w : {1, 3, 20, 40, 79, 100, 160, 250})
          for (int h : {1, 2, 5, 8, 24, 50, 80}) {
            ViewState view;
            view.charset = charset;
            view.screen = screen;
            view.dialog = dialog;
            view.selected = w % 3;
            view.scroll = w;
            view.window_s = h % 2 ? 10 : 0;
            view.logarithmic = h % 2;
            view.notice = h == 8 ? evil_text : "";
            view.source = evil_text;
            Canvas canvas(w, h);
            draw(canvas, model, view);
            for (int y = 0; y < h; ++y)
              for (int x = 0; x < w; ++x) {
                const char32_t g = canvas.at(x, y).glyph;
                ASSERT_TRUE(g >= 0x20 && g != 0x7f && !(g >= 0x80 && g < 0xa0) &&
                            (charset == Charset::unicode || g < 0x7f))
                    << static_cast<unsigned>(g) << " at " << x << "," << y << " of " << w << "x" << h;
              }
          }
  for (const std::string& text : {pair_lines(model, Charset::unicode), text_lines(model, Charset::ascii)})
    for (char c : text) ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n');
  const std::string json = json_line(model);
  for (char c : json) ASSERT_GE(static_cast<unsigned char>(c), 0x20);
  EXPECT_THAT(json, Not(HasSubstr("NaN")));
  for (const Event& event : model.events())
    for (char c : event_line(event, 0)) ASSERT_GE(static_cast<unsigned char>(c), 0x20);
}

}  // namespace

TEST(Hostile, ValuesNamesAndTimesNeitherCrashNorReachTheScreen) {
  Model model;
  const double values[] = {not_a_number, infinity, -infinity, 1e308, -1e308, 5e-324, 0, -1};
  const std::int64_t counts[] = {largest_int, smallest_int, -1, 0, 1};
  std::int64_t n = 0;
  const auto value = [&] { return values[static_cast<std::size_t>(n++) % std::size(values)]; };
  const auto number = [&] { return counts[static_cast<std::size_t>(n++) % std::size(counts)]; };
  for (std::int64_t step = 0; step < 3000; ++step) {
    const Now now{step * 50'000, step % 500 == 0 ? number() : step * 50'000};
    problem_t p = problem_at("lidar", step % 3 ? "camera" : evil_text, step, 10);
    calibration_t c = calibration_at(p, step % 2);
    status_t s = status_of(step % 4 ? evil_text : "egocal-fast", "fast", number());
    for (double* field :
         {&p.truth_pos[0], &p.truth_quat[1], &p.prior_pos[2], &p.prior_quat[0], &p.time_offset,
          &p.time_offset_stddev, &p.weight_rotation, &c.pos[0], &c.pos[2], &c.quat[0], &c.quat[3], &c.cost,
          &c.lower_bound, &c.gap, &c.scaled_gap, &c.stddev[0], &c.stddev[5], &c.reach_translation})
      if (n++ % 5 == 0) *field = value();
    for (std::int64_t* field : {&p.utime, &p.seq, &p.matched, &p.left_out, &p.rejected, &p.received_mono_us,
                                &c.utime, &c.seq, &c.pairs, &c.solve_ns, &c.verify_ns, &c.latency_us, &s.run})
      if (n++ % 7 == 0) *field = number();
    if (step % 11 == 0) p.session = c.session = number();
    if (step % 13 == 0) p.stride = static_cast<std::int32_t>(number());
    if (step % 17 == 0) p.mode = c.status = static_cast<std::int8_t>(step);
    p.choice = c.hint = c.method = s.last_error = s.state = evil_text;
    s.pid = -1;
    s.counters[0].name = step % 2 ? "lost" : evil_text;
    s.counters[0].value = number();
    model.on_problem(p, now);
    model.on_calibration(c, now);
    model.on_status(s, now);
    command_t command{};
    command.verb = command.sensor_a = command.to = evil_text;
    model.on_command(command, now);
    model.tick(now);
    if (step % 750 == 0) {
      expect_clean_screens(model);
      if (HasFatalFailure()) return;
    }
  }
  expect_clean_screens(model);
  EXPECT_LE(model.events().size(), Model::max_events);
}

TEST(Hostile, AFloodOfNamesIsBoundedAndCounted) {
  Model model;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "sensor" + std::to_string(i);
    const problem_t p = problem_at(name, name, i, 10);
    model.on_problem(p, {i, i});
    model.on_calibration(calibration_at(p, false), {i, i});
    model.on_status(status_of(name, "fast", 1), {i, i});
  }
  EXPECT_EQ(model.pairs().size(), Model::max_pairs);
  EXPECT_EQ(model.processes().size(), Model::max_processes);
  for (int i = 0; i < 2000; ++i) model.note(Severity::info, "stderr", std::to_string(i), {i, i});
  EXPECT_EQ(model.events().size(), Model::max_events);
  EXPECT_EQ(model.events().back().text, "1999");
  EXPECT_GT(model.events_seen(), 2000);
  EXPECT_EQ(model.ignored(), 3 * 1000 - 2 * 256 - 64);
  expect_clean_screens(model);
}

TEST(Hostile, TimeRunningBackwardsIsSaidAndTheCurveGoesOn) {
  PairDrive drive;
  drive.run(100);
  drive.fresh();
  drive.change_problem = [](problem_t& p) { p.utime = 0; };
  drive.run(1);
  EXPECT_THAT(drive.fresh(),
              ElementsAre("lidar -> camera: time ran backwards in the problems of one session"));
  drive.change_problem = [](problem_t& p) { p.utime = largest_int; };
  drive.run(1);
  drive.change_problem = [](problem_t&) {};
  drive.run(10);
  EXPECT_NEAR(drive.pair().solvers[0].history.last_time(), 11.1, 1e-9);
}

}  // namespace egocal::monitor::test_hostile
