// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What the screens say of a model, and what the keys do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "egocal/monitor/view.hpp"
#include "scene.hpp"

namespace egocal::monitor::test_view {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr Now some_time{1'000'000, test::begin_utime};

KeyPress character(char c) {
  return {Key::character, c};
}

class View : public ::testing::Test {
 protected:
  View() {
    view.charset = Charset::unicode;
    send([](problem_t&) {}, [](calibration_t&) {});
  }
  void send(const std::function<void(problem_t&)>& change_problem,
            const std::function<void(calibration_t&)>& change_answer, bool both = true) {
    problem_t problem = test::problem_at("lidar", "camera", step++, 10);
    change_problem(problem);
    model.on_problem(problem, some_time);
    for (bool global : {false, true}) {
      if (global && !both) continue;
      calibration_t answer = test::calibration_at(problem, global);
      change_answer(answer);
      model.on_calibration(answer, some_time);
    }
  }
  std::string shown(Screen screen, int w, int h) {
    view.screen = screen;
    Canvas canvas(w, h);
    draw(canvas, model, view);
    return canvas.to_text();
  }

  Model model;
  ViewState view;
  std::int64_t step = 100;
};

}  // namespace

TEST_F(View, APairsCardSaysAllOfIt) {
  const std::string text = shown(Screen::overview, 110, 30);
  for (const char* part :
       {"lidar → camera", "optimal (proven)", "egocal-", "3-D", "101 motions", "translation", "roll", "±",
        "cm", "error", "of 1", "solve", "verify", "end to end", "q quit", "? help"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(View, DetailHasBothSolversBothDirectionsAndFourCurves) {
  for (const auto& [w, h] : {std::pair{80, 24}, {110, 42}, {200, 60}}) {
    const std::string text = shown(Screen::detail, w, h);
    for (const char* part :
         {"rotation error [°]", "translation error [cm]", "scaled", "execution time [µs]", "Observability",
          "Solvers", "fast", "global", "sqp", "dual", "pose of camera in lidar", "pose of lidar in camera",
          "q wxyz", "r p y", "x y z"})
      EXPECT_THAT(text, HasSubstr(part)) << w << "x" << h;
  }
  const std::string text = shown(Screen::detail, 110, 42);
  EXPECT_THAT(text, HasSubstr("R | t"));
  // (0.5, -0.5, 0.5, -0.5), turned by a little; and the way back
  EXPECT_THAT(text, ::testing::ContainsRegex("q wxyz +0\\.50.* -0\\.49.* 0\\.50.* -0\\.49"));
}

TEST_F(View, OnlyAVerdictSaysThatTheMotionsShowEverything) {
  send([](problem_t&) {}, [](calibration_t& answer) { answer.stddev[0] = 124; });
  EXPECT_THAT(shown(Screen::detail, 110, 42), Not(HasSubstr("the motions show everything")));
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("shown, but not judged yet"));
  for (const auto& [verdict, text] : {std::pair{Verdict::good, "the motions show everything"},
                                      {Verdict::incomplete, "shown, not yet exact enough"},
                                      {Verdict::doubtful, "shown, but see the verdict"},
                                      {Verdict::contradictory, "shown, but see the verdict"}}) {
    Diagnosis diagnosis;
    diagnosis.verdict = verdict;
    diagnosis.reason = "a reason";
    const verdict_t message = test::verdict_at(diagnosis, test::begin_utime, test::begin_utime, step);
    const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
    ASSERT_TRUE(received) << received.reason;
    model.on_verdict(message, *received.value, some_time);
    EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr(text));
  }
}

TEST_F(View, WhatTheMotionsDoNotShowIsSaid) {
  send([](problem_t&) {},
       [](calibration_t& answer) {
         answer.observable[2] = 0;
         answer.stddev[2] = std::numeric_limits<double>::infinity();
         answer.hint = "turn while going uphill";
       });
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("not shown: z"));
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("turn while going uphill"));
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("not shown"));
  send([](problem_t& p) { p.mode = 1; },
       [](calibration_t& answer) {
         for (int i : {2, 3, 4}) answer.observable[i] = 0;
       });
  EXPECT_THAT(shown(Screen::detail, 110, 42), HasSubstr("plane")) << "the ground says it";
  EXPECT_THAT(shown(Screen::overview, 110, 30), Not(HasSubstr("not shown: z")));
}

TEST_F(View, RejectedMotionsAndTheClocksAreSaid) {
  send(
      [](problem_t& p) {
        p.rejected = 17;
        p.left_out = 4;
        p.time_offset = -0.0123;
        p.time_offset_stddev = 0.0004;
      },
      [](calibration_t&) {});
  const std::string text = shown(Screen::detail, 140, 42);
  EXPECT_THAT(text, HasSubstr("17 rejected"));
  EXPECT_THAT(text, HasSubstr("4 outliers"));
  EXPECT_THAT(text, HasSubstr("offset -12.3 ±0.4 ms"));
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("17 rejected"));
}

TEST_F(View, PairsOfOneSensorCanBeToldApart) {
  for (const char* b : {"camera_left", "camera_right", "radar_front_long_range", "radar_rear"}) {
    model.on_problem(test::problem_at("lidar_top_front", b, 1, 10), some_time);
    model.note(Severity::info, pair_name("lidar_top_front", b), "noted", some_time);
  }
  for (const int w : {80, 110})
    for (const Screen screen : {Screen::overview, Screen::events})
      for (const char* end : {"left ", "ight ", "ange ", "rear "})
        EXPECT_THAT(shown(screen, w, 40), HasSubstr(end)) << w;
  EXPECT_THAT(shown(Screen::overview, 200, 40), HasSubstr("lidar_top_front → radar_"));
}

// Not even the question whether to forget a pair's motions said which of them is meant.
TEST_F(View, ALongNameIsCutWhereItDoesNotDifferOnCardsAndInQuestions) {
  model = Model();
  for (const char* b : {"front_left_upper_roof_camera_018", "front_left_upper_roof_camera_019"})
    model.on_problem(test::problem_at("lidar", b, 1, 10), some_time);
  EXPECT_THAT(shown(Screen::overview, 110, 40), HasSubstr("amera_018 "));
  view.selected = 1;
  for (const int w : {40, 60, 80, 110}) EXPECT_THAT(shown(Screen::detail, w, 24), HasSubstr("a_019 ")) << w;
  for (const Dialog dialog : {Dialog::reset, Dialog::pause, Dialog::resume, Dialog::export_format}) {
    view.dialog = dialog;
    EXPECT_THAT(shown(Screen::overview, 80, 24), HasSubstr("camera_019"));
  }
}

TEST_F(View, NoNumberLosesADigit) {
  for (const std::int64_t lost : {54'321, 99'999, 123'456'789}) {
    status_t status = test::status_of("egocal-pairing", "pairing", 5);
    for (const char* name : {"lost", "rejected: late"}) {
      counter_t& counter = status.counters.emplace_back();
      counter.name = name;
      counter.value = lost;
    }
    status.n_counters = static_cast<std::int32_t>(status.counters.size());
    model.on_status(status, some_time);
    const std::string text = count(lost);
    EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("lost " + text + " "));
    EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("rejected " + text + " "));
  }
  // millimetres taken for metres
  for (const auto& [metres, text] : {std::pair{1000.0, " 1e+05 -1e+05 "},
                                     {-1000.0, "-1e+05  1e+05 "},
                                     {-123.456, "-12346  12346 "},
                                     {-1.5, "-150.0  150.0 "}}) {
    send([](problem_t&) {},
         [metres = metres](calibration_t& answer) {
           answer.pos[0] = metres;
           answer.pos[1] = -metres;
         });
    EXPECT_THAT(shown(Screen::overview, 160, 8), HasSubstr(text));
  }
}

TEST_F(View, LargeDistancesStandApartAndKeepTheirUnits) {
  const std::string number = " +-?[0-9][0-9.e+]*", row = number + number + number;
  for (const double metres : {502.2346, -502.2346, 999.9, -1234.567}) {
    send([](problem_t&) {},
         [=](calibration_t& answer) {
           answer.pos[0] = metres;
           answer.pos[1] = 181.2268;
           answer.pos[2] = metres;
           answer.stddev[0] = answer.stddev[2] = std::abs(metres);
         });
    for (const auto& [w, h] : {std::pair{76, 24}, {80, 24}, {110, 42}}) {
      const std::string detail = shown(Screen::detail, w, h);
      EXPECT_THAT(detail, ::testing::ContainsRegex("x y z" + row + " +cm +x y z" + row + " +cm")) << w;
      EXPECT_THAT(detail, ::testing::ContainsRegex("error t +[0-9.e+]+ c?m +[0-9.e+]+ c?m")) << w;
      EXPECT_THAT(detail, ::testing::ContainsRegex("±[0-9]+(\\.[0-9])? c?m\n")) << w;
    }
    EXPECT_THAT(shown(Screen::detail, 40, 8), ::testing::ContainsRegex("t" + row + " ±[0-9.e+]+ cm"));
    EXPECT_THAT(shown(Screen::overview, 60, 10), ::testing::ContainsRegex("[0-9] c?m +[0-9]")) << "error";
    EXPECT_THAT(shown(Screen::overview, 110, 30),
                ::testing::ContainsRegex("x" + number + " ±[0-9.e+]+ +y" + number + " ±[0-9.]+ +z" + number +
                                         " ±[0-9.e+]+ cm"));
  }
  for (const Charset charset : {Charset::unicode, Charset::ascii}) {
    view.charset = charset;
    send([](problem_t& p) { p.has_truth = p.has_prior = 0; },
         [](calibration_t& answer) { answer.stddev[0] = 576.15; });
    EXPECT_THAT(shown(Screen::overview, 60, 10),
                HasSubstr(charset == Charset::unicode ? " ±57615 cm " : " +-576.1 m "));
  }
  for (const Charset charset : {Charset::unicode, Charset::ascii}) {
    view.charset = charset;
    send([](problem_t&) {},
         [](calibration_t& answer) {
           answer.stddev[0] = 124;
           answer.stddev[2] = 1300;
         });
    EXPECT_THAT(shown(Screen::overview, 80, 24),
                ::testing::ContainsRegex("(±|[+]-)12400 +y .* (±|[+]-)1e[+]05 ?cm"));
    EXPECT_THAT(shown(Screen::overview, 80, 24),
                ::testing::ContainsRegex("yaw .* (±|[+]-)[0-9.]+(°| °|deg)"));
    EXPECT_THAT(shown(Screen::overview, 60, 10), ::testing::ContainsRegex(" [0-9.]+(°|deg)[ \n]"));
  }
  // the last part of the quaternion was cut at 76 to 79 columns
  EXPECT_THAT(shown(Screen::detail, 76, 24),
              ::testing::ContainsRegex(
                  "q wxyz( +-?[0-9]\\.[0-9][0-9][0-9]){4} +q wxyz( +-?[0-9]\\.[0-9][0-9][0-9]){4}"));
}

TEST_F(View, AStrideThatIsNotInForceIsNotShown) {
  EXPECT_THAT(shown(Screen::detail, 140, 42), HasSubstr("stride 1"));
  send(
      [](problem_t& p) {
        p.stride = 16;
        p.choice = "sum over strides, 1.1 steps in the mean, weighted by the residuals";
      },
      [](calibration_t&) {});
  EXPECT_THAT(shown(Screen::detail, 140, 42), HasSubstr("many strides"));
  EXPECT_THAT(shown(Screen::detail, 140, 42), Not(HasSubstr("stride 16")));
}

TEST_F(View, ProcessesSayWhoWhereAndWhatIsWrong) {
  status_t status = test::status_of("egocal-fast", "fast", 5);
  status.last_error = "no global solver is alive";
  model.on_status(status, some_time);
  for (int w : {100, 140})
    EXPECT_THAT(shown(Screen::overview, w, 30), HasSubstr("no global solver is alive")) << w;
  EXPECT_THAT(shown(Screen::overview, 140, 30), HasSubstr("pid 4711 on car"));
  model.tick({some_time.mono_us + 4'000'000, some_time.wall_us});
  EXPECT_THAT(shown(Screen::overview, 110, 30), HasSubstr("GONE"));
}

// At 80 columns, the width of most terminals, two characters of it were shown.
TEST_F(View, AnErrorHasRoomBeforeTheRates) {
  status_t status = test::status_of("egocal-pairing", "pairing", 5);
  model.on_status(status, some_time);
  EXPECT_THAT(shown(Screen::overview, 80, 24), HasSubstr("in "));
  status.last_error = "/data/s.state: cannot be written: No space left on device";
  model.on_status(status, some_time);
  for (const int w : {80, 100, 120})
    EXPECT_THAT(shown(Screen::overview, w, 24),
                ::testing::ContainsRegex("rejected 0 +[~/a-z]*s\\.state: canno"))
        << w;
  EXPECT_THAT(shown(Screen::overview, 120, 24), HasSubstr("in "));
}

TEST_F(View, NothingIsCutInHalfBesideTheClock) {
  for (int w = 40; w < 160; ++w) {
    std::string first = shown(Screen::detail, w, 30);
    first = first.substr(0, first.find('\n'));
    ASSERT_GE(first.size(), 8u);
    EXPECT_THAT(first.substr(first.size() - 8), ::testing::MatchesRegex("[0-9:]*")) << first;
    EXPECT_EQ(first[first.size() - 9], ' ') << first;
  }
}

TEST_F(View, KeysMoveBetweenScreensAndPairs) {
  for (const char* b : {"radar", "imu"}) model.on_problem(test::problem_at("lidar", b, 1, 10), some_time);
  press(view, model, {Key::down});
  EXPECT_EQ(view.selected, 1);
  press(view, model, {Key::end});
  EXPECT_EQ(view.selected, 2);
  press(view, model, {Key::down});
  EXPECT_EQ(view.selected, 2) << "stays at the end";
  press(view, model, character('n'));
  EXPECT_EQ(view.selected, 0) << "goes round";
  press(view, model, character('N'));
  EXPECT_EQ(view.selected, 2);
  press(view, model, {Key::enter});
  EXPECT_EQ(view.screen, Screen::detail);
  press(view, model, {Key::escape});
  EXPECT_EQ(view.screen, Screen::overview);
  press(view, model, character('e'));
  EXPECT_EQ(view.screen, Screen::events);
  press(view, model, {Key::tab});
  EXPECT_EQ(view.screen, Screen::overview);
  EXPECT_EQ(press(view, model, character('q')).kind, Action::Kind::quit);
}

TEST_F(View, EventsScrollAPageAtATimeAndNoFurtherThanThereAre) {
  for (int i = 0; i < 100; ++i)
    model.note(Severity::info, "x", "event " + std::to_string(i) + ".", some_time);
  view.height = 20;
  press(view, model, character('e'));
  EXPECT_THAT(shown(Screen::events, 80, 20), HasSubstr("event 99."));
  press(view, model, {Key::home});
  const std::string oldest = shown(Screen::events, 80, 20);
  EXPECT_THAT(oldest, HasSubstr("lidar → camera"));
  press(view, model, {Key::down});
  EXPECT_NE(shown(Screen::events, 80, 20), oldest) << "the first step back is seen";
  press(view, model, {Key::end});
  press(view, model, {Key::page_up});
  EXPECT_THAT(shown(Screen::events, 80, 20), HasSubstr("event 82."));
  EXPECT_THAT(shown(Screen::events, 80, 20), Not(HasSubstr("event 83.")));
}

TEST_F(View, TheScreenOfEventsShowsThemWhole) {
  const std::string text =
      "no global solver is alive: global solutions are computed here as well, and take longer than those "
      "that the process of the global solver finds on another core.";
  model = Model();
  model.note(Severity::info, "lidar -> camera", "this was the very first one.", some_time);
  for (int i = 0; i < 2; ++i) model.note(Severity::warning, "egocal-fast", text, some_time);
  for (const int w : {20, 30, 40, 60, 80, 110, 200}) {
    view.width = w;
    view.height = 24;
    std::istringstream words(std::string(w > 20 ? "egocal-fast " : "") + text + " (2 times)");
    const std::string screen = shown(Screen::events, w, 24);
    for (std::string word; words >> word;) EXPECT_THAT(screen, HasSubstr(word)) << w;
    // its begin and its end can be reached where they are not on the screen
    view.height = 6;
    press(view, model, character('e'));
    EXPECT_THAT(shown(Screen::events, w, 6), HasSubstr("times)")) << w;
    press(view, model, {Key::home});
    const std::string oldest = shown(Screen::events, w, 6);
    EXPECT_THAT(oldest, HasSubstr("lidar →")) << w;
    if (w > 80) continue;
    press(view, model, {Key::down});
    EXPECT_NE(shown(Screen::events, w, 6), oldest) << "the first step back is seen";
    for (int i = 0; i < 40; ++i) press(view, model, {Key::down});
    EXPECT_THAT(shown(Screen::events, w, 6), HasSubstr("times)")) << w;
  }
  EXPECT_THAT(shown(Screen::overview, 80, 24), HasSubstr("~")) << "a row each";
}

// Each key press shows less: windows that are longer than the session are passed over.
TEST_F(View, ZoomGoesInAndOut) {
  EXPECT_EQ(view.window_s, 0);
  send([](problem_t& p) { p.session -= 100'000'000; }, [](calibration_t&) {});
  const calibration_t& answer = *model.pairs()[0].answer();
  const double session = 1e-6 * static_cast<double>(answer.utime - answer.session);
  std::vector<double> in, out, expected;
  for (const double window : {7200.0, 1800.0, 300.0, 60.0, 30.0, 10.0})
    if (window < session) expected.push_back(window);
  ASSERT_FALSE(expected.empty()) << "a session of " << session << " s";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    press(view, model, character('+'));
    in.push_back(view.window_s);
  }
  EXPECT_EQ(in, expected);
  press(view, model, character('+'));
  EXPECT_EQ(view.window_s, 10) << "no further in";
  for (int i = 0; i < 7; ++i) press(view, model, character('-'));
  EXPECT_EQ(view.window_s, 0) << "all";
  press(view, model, character('l'));
  EXPECT_FALSE(view.logarithmic);
}

TEST_F(View, PausedIsSeenOnEveryScreen) {
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  model.on_command(command, some_time);
  for (const auto& [width, height] : {std::pair{120, 40}, std::pair{80, 24}, std::pair{40, 8}})
    for (const Screen screen : {Screen::overview, Screen::detail})
      EXPECT_THAT(shown(screen, width, height), HasSubstr("PAUSED")) << width << "x" << height;
}

TEST_F(View, APausedViewSaysSoOnEveryScreen) {
  view.frozen = true;
  for (const bool network_away : {false, true}) {
    if (network_away) view.network_error = "no route";
    for (int width = 20; width <= 130; ++width)
      for (const Screen screen : {Screen::overview, Screen::detail, Screen::events, Screen::streams})
        EXPECT_THAT(shown(screen, width, 8), HasSubstr("VIEW PAUSED")) << width;
  }
}

TEST_F(View, NoPartOfAHeaderStandsAlone) {
  command_t command{};
  command.to = "*";
  command.verb = "pause";
  for (const bool paused : {false, true}) {
    if (paused) model.on_command(command, some_time);
    for (int w = 20; w < 160; ++w) {
      std::string first = shown(Screen::detail, w, 8);
      first = first.substr(0, first.find('\n'));
      EXPECT_THAT(first, Not(::testing::ContainsRegex("by +[0-9:]*$"))) << first;
    }
  }
}

TEST_F(View, EveryColumnHasAHeadingOfItsOwn) {
  const std::string truth = shown(Screen::overview, 60, 10);
  EXPECT_THAT(truth, HasSubstr("error t"));
  EXPECT_THAT(truth, HasSubstr("error R"));
  send(
      [](problem_t& p) {
        p.sensor_b = "radar";
        p.has_truth = p.has_prior = 0;
      },
      [](calibration_t& answer) { answer.sensor_b = "radar"; });
  const std::string spread = shown(Screen::overview, 60, 12);
  EXPECT_THAT(spread, HasSubstr("spread t"));
  EXPECT_THAT(spread, HasSubstr("spread R"));
}

TEST_F(View, HelpSaysWhatAProofIsNot) {
  view.dialog = Dialog::help;
  for (const auto& [w, h] : {std::pair{80, 24}, {66, 16}}) {
    const std::string text = shown(Screen::overview, w, h);
    EXPECT_THAT(text, HasSubstr("the best fit to the motions, right or wrong.")) << w << "x" << h;
    EXPECT_THAT(text, HasSubstr("magenta: global solver")) << w << "x" << h;
  }
}

TEST_F(View, ANetworkThatIsAwayIsSeenOnEveryScreen) {
  view.network_error = "no multicast";
  for (const auto& [width, height] : {std::pair{120, 40}, std::pair{80, 24}, std::pair{40, 8}})
    for (const Screen screen : {Screen::overview, Screen::detail, Screen::events, Screen::streams})
      EXPECT_THAT(shown(screen, width, height), HasSubstr("NO NETWORK")) << width << "x" << height;
}

TEST_F(View, DialogsAreWholeOnSmallScreens) {
  const struct {
    Dialog dialog;
    std::vector<std::string> parts;
  } dialogs[] = {
      {Dialog::help,
       {"q quit", "n N pair", "up dn choose", "s streams", "+ - zoom", "r reset", "spc pause view",
        "^L redraw", "^Z suspend"}},
      {Dialog::reset, {"Forget all motions", "camera?", "y  yes", "any other key  no"}},
      {Dialog::pause,
       {"Pause the calibration", "camera?", "Motions in the meantime", "y  yes", "any other key  no"}},
      {Dialog::resume, {"Resume the calibration", "camera?", "y  yes", "any other key  no"}},
      {Dialog::export_format, {"Write the answer", "y YAML", "k Kalibr", "any other key  nothing"}}};
  for (const auto& [dialog, parts] : dialogs) {
    view.dialog = dialog;
    const std::string text = shown(Screen::overview, 40, 8);
    for (const std::string& part : parts) EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST_F(View, AQuestionNamesItsPairAndItsKeysOnTheSmallestScreens) {
  for (const Dialog dialog : {Dialog::reset, Dialog::pause, Dialog::resume, Dialog::export_format}) {
    view.dialog = dialog;
    const std::string text = shown(Screen::overview, 20, 5);
    EXPECT_THAT(text, HasSubstr("lidar → camera?"));
    if (dialog == Dialog::export_format)
      for (const char* key : {"y YAML", "r ROS", "u URDF", "k Kalibr"}) EXPECT_THAT(text, HasSubstr(key));
    else
      for (const char* key : {"y yes", "other key no"}) EXPECT_THAT(text, HasSubstr(key));
  }
}

TEST_F(View, ARowHasANameOnTheSmallestScreensAndAnAgeAt40Columns) {
  model.on_problem(test::problem_at("lidar", "radar", 1, 10), some_time);
  for (const int w : {20, 24, 30, 33}) {
    const std::string text = shown(Screen::overview, w, 5);
    EXPECT_THAT(text, ::testing::ContainsRegex("l[~idar]+ → c[~amer]+a +not jud")) << w;
    EXPECT_THAT(text, ::testing::ContainsRegex("l[~idar]+ → r[~ad]+a?r +solving")) << w;
  }
  for (const int w : {40, 41, 48, 60, 80}) EXPECT_THAT(shown(Screen::overview, w, 8), HasSubstr(" now")) << w;
}

TEST_F(View, NothingIsCommandedWithoutAYes) {
  for (char key : {'r', 'p'})
    for (char answer : {'n', 'r', 'p', 'q', ' ', '?'}) {
      EXPECT_EQ(press(view, model, character(key)).kind, Action::Kind::none);
      EXPECT_NE(view.dialog, Dialog::none);
      EXPECT_EQ(press(view, model, character(answer)).kind, Action::Kind::none);
      EXPECT_EQ(view.dialog, Dialog::none);
    }
  press(view, model, character('r'));
  const Action action = press(view, model, character('y'));
  EXPECT_EQ(action.kind, Action::Kind::reset);
  EXPECT_EQ(action.a, "lidar");
  EXPECT_EQ(action.session, test::begin_utime) << "this session and no later one";
  view.live = false;
  press(view, model, character('r'));
  EXPECT_EQ(view.dialog, Dialog::none);
  EXPECT_THAT(view.notice, HasSubstr("log"));
  press(view, model, character('x'));
  EXPECT_EQ(view.dialog, Dialog::export_format) << "a log's answer can be exported";
}

TEST_F(View, WhatIsExportedIsTheAnswerThatCounts) {
  const auto extrinsic = extrinsic_of(model.pairs()[0]);
  ASSERT_TRUE(extrinsic);
  EXPECT_EQ(extrinsic->parent, "lidar");
  EXPECT_EQ(extrinsic->child, "camera");
  EXPECT_TRUE(extrinsic->certified);
  send([](problem_t&) {},
       [](calibration_t& answer) { answer.pos[1] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_FALSE(extrinsic_of(model.pairs()[0])) << "nothing rather than nonsense";
}

TEST_F(View, WhatIsExportedStatesItsVerdictAndWhatItRestsOn) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::incomplete;
  diagnosis.reason = "z is not known.";
  const verdict_t message = test::verdict_at(diagnosis, test::begin_utime, test::begin_utime, step);
  const bus::Checked<bus::ReceivedVerdict> received = bus::to_verdict(message);
  ASSERT_TRUE(received) << received.reason;
  model.on_verdict(message, *received.value, some_time);
  const auto hide_z = [](calibration_t& answer) {
    answer.observable[2] = 0;
    answer.stddev[2] = std::numeric_limits<double>::infinity();
  };
  send([](problem_t& problem) { problem.has_prior = 0; }, hide_z);
  const auto extrinsic = extrinsic_of(model.pairs()[0]);
  ASSERT_TRUE(extrinsic);
  EXPECT_EQ(extrinsic->verdict, "incomplete");
  EXPECT_EQ(extrinsic->reason, "z is not known.");
  ASSERT_TRUE(extrinsic->backing);
  EXPECT_EQ((*extrinsic->backing)[2], Backing::none);
  EXPECT_EQ((*extrinsic->backing)[5], Backing::motions);

  send([](problem_t& problem) { problem.has_prior = 1; }, hide_z);
  EXPECT_EQ(extrinsic_of(model.pairs()[0])->backing->at(2), Backing::nominal);

  send(
      [](problem_t& problem) {
        problem.mode = 1;
        problem.plane_a[2] = problem.plane_b[2] = 1;
      },
      [&](calibration_t& answer) {
        hide_z(answer);
        answer.method = "slsqp";
        answer.hint = "drive curves: they show the yaw";
      });
  EXPECT_EQ(extrinsic_of(model.pairs()[0])->backing->at(2), Backing::planes) << "whatever else is missing";
}

}  // namespace egocal::monitor::test_view
