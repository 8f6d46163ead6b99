// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "egocal/monitor/layout.hpp"
#include "egocal/monitor/view.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_layout {
namespace {

void expect_apart(const std::vector<Rect>& rects, int w, int h) {
  for (std::size_t i = 0; i < rects.size(); ++i) {
    const Rect& r = rects[i];
    if (r.empty()) continue;
    ASSERT_TRUE(r.x >= 0 && r.y >= 0 && r.x + r.w <= w && r.y + r.h <= h) << i << " at " << w << "x" << h;
    for (std::size_t k = i + 1; k < rects.size(); ++k)
      ASSERT_TRUE(intersection(r, rects[k]).empty()) << i << " and " << k << " at " << w << "x" << h;
  }
}

}  // namespace

TEST(Layout, NothingOverlapsOrLeavesTheScreenAtAnySize) {
  for (int w = 1; w <= 250; ++w)
    for (int h = 1; h <= 80; ++h) {
      for (int pairs : {0, 1, 3, 20}) {
        const OverviewLayout o = layout_overview(w, h, pairs, 5);
        expect_apart({o.header, o.pairs, o.summary, o.processes, o.events, o.keys}, w, h);
        ASSERT_FALSE(o.pairs.empty());
      }
      const DetailLayout d = layout_detail(w, h);
      expect_apart({d.header, d.verdict, d.summary, d.plots[0], d.plots[1], d.plots[2], d.plots[3],
                    d.observability, d.solvers, d.directions[0], d.directions[1], d.keys},
                   w, h);
      const EventsLayout e = layout_events(w, h);
      expect_apart({e.header, e.list, e.keys}, w, h);
    }
}

TEST(Layout, TheAnswerIsVisibleAt40x8AndHostileValuesNeverReachTheScreen) {
  Model model;
  const Now now{1000000, 1000000};
  const auto problem = test::problem_at("lidar", "camera", 400, 10);
  model.on_problem(problem, now);
  model.on_calibration(test::calibration_at(problem, false), now);
  ViewState view;
  Canvas small(40, 8);
  draw(small, model, view);
  EXPECT_NE(small.to_text().find("optimal"), std::string::npos) << small.to_text();

  auto evil = test::calibration_at(problem, false);
  evil.sensor_a = "\x1b[2J\n" + std::string(200, 'W');
  evil.pos[0] = evil.quat[1] = evil.scaled_gap = std::numeric_limits<double>::quiet_NaN();
  evil.stddev[0] = evil.cost = std::numeric_limits<double>::infinity();
  evil.utime = std::numeric_limits<std::int64_t>::max();
  model.on_calibration(evil, now);
  model.note(Severity::bad, "stderr", "\x1b]0;x\x07\xff", now);
  for (const Charset charset : {Charset::ascii, Charset::unicode})
    for (const Screen screen : {Screen::overview, Screen::detail, Screen::events})
      for (int w : {1, 7, 40, 80, 120, 250})
        for (int h : {1, 2, 8, 24, 60}) {
          view.charset = charset;
          view.screen = screen;
          view.selected = 1;
          Canvas canvas(w, h);
          draw(canvas, model, view);
          for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
              const char32_t g = canvas.at(x, y).glyph;
              ASSERT_TRUE(g >= 0x20 && g != 0x7f && (charset == Charset::unicode || g < 0x7f))
                  << static_cast<unsigned>(g);
            }
        }
}

}  // namespace egocal::monitor::test_layout
