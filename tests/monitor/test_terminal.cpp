// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The real monitor in a real terminal (tmux): what reaches the screen, and in what state the terminal is
// left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <regex>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "scene.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"
#include "terminal_session.hpp"
#include "tmux.hpp"

namespace egocal {

using namespace std::chrono_literals;
using ::testing::MatchesRegex;
using ::testing::Not;

struct Kind {
  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) {
    return out << kind.term << " " << kind.locale;
  }
  const char* term;
  const char* locale;
  bool ascii;
  bool colours;
};

class EveryTerminal : public ::testing::TestWithParam<Kind> {};

TEST_P(EveryTerminal, ShowsWhatTheViewsDrewAndIsLeftAsItWas) {
  const Kind& kind = GetParam();
  Tmux tmux(100, 30, script(environment(kind.term, kind.locale), "--log " + recording));
  const std::string overview = expected("overview", 100, 30, kind.ascii);
  expect_screen(tmux, overview);
  EXPECT_FALSE(tmux.cursor_visible() && std::string(kind.term) != "vt100");  // a vt100 cannot hide it
  const std::string arrow = kind.ascii ? "lidar -> camera" : "lidar → camera";
  EXPECT_THAT(overview, HasSubstr(arrow));
  EXPECT_THAT(overview, HasSubstr("optimal (proven)"));

  const std::string coloured = tmux.coloured_screen();
  EXPECT_EQ(std::regex_search(coloured, std::regex("\x1b\\[[0-9;]*3[1-7]")), kind.colours);
  EXPECT_THAT(coloured, Not(HasSubstr("38;5")));  // eight colours do

  tmux.keys("Enter");
  const std::string detail = expected("detail", 100, 30, kind.ascii);
  expect_screen(tmux, detail);
  bool braille = false, beyond_ascii = false;
  for (std::size_t i = 0; i < detail.size(); ++i) {
    const auto byte = static_cast<unsigned char>(detail[i]);
    beyond_ascii = beyond_ascii || byte > 0x7e;
    if (detail.compare(i, 2, "\xe2\xa0") >= 0 && detail.compare(i, 2, "\xe2\xa3") <= 0) braille = true;
  }
  EXPECT_EQ(braille, !kind.ascii);
  EXPECT_EQ(beyond_ascii, !kind.ascii);

  tmux.keys("e");
  expect_screen(tmux, expected("events", 100, 30, kind.ascii));
  tmux.keys("q");
  expect_shell_is_back(tmux);
  EXPECT_EQ(read_text(tmux.folder() / "status"), "0\n");
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryTerminal,
    ::testing::Values(Kind{"xterm-256color", "C.UTF-8", false, true}, Kind{"xterm-256color", "C", true, true},
                      Kind{"xterm", "C.UTF-8", false, true}, Kind{"xterm", "C", true, true},
                      Kind{"screen", "C.UTF-8", false, true}, Kind{"screen", "C", true, true},
                      Kind{"linux", "C.UTF-8", true, true}, Kind{"linux", "C", true, true},
                      Kind{"vt100", "C.UTF-8", true, false}, Kind{"vt100", "C", true, false}),
    [](const auto& kind) {
      std::string name = std::string(kind.param.term) + (kind.param.locale[1] ? "_utf8" : "_c");
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(Terminal, ADumbOneGetsPlainLines) {
  for (const std::string term : {"dumb", "unknown-terminal"}) {
    Tmux tmux(160, 40, "read go\n" + script(environment(term), "--log " + recording));
    tmux.run("pipe-pane -t s 'cat > " + (tmux.folder() / "raw").string() + "'");
    tmux.keys("Enter");
    expect_shell_is_back(tmux);
    EXPECT_TRUE(tmux.shows("lidar -> camera: ")) << tmux.screen();
    std::string raw;
    EXPECT_TRUE(until([&] {
      return (raw = read_text(tmux.folder() / "raw")).find("the shell is back") != std::string::npos;
    }));
    EXPECT_THAT(raw, HasSubstr("printing lines instead"));
    for (char c : raw)
      ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\r') << term << "\n" << raw;
  }
}

TEST(Terminal, NoColoursWhereNoneAreWanted) {
  for (const std::string wish : {"--mono", "NO_COLOR"}) {
    const std::string env = environment("xterm-256color") + (wish == "NO_COLOR" ? "NO_COLOR=1 " : "");
    Tmux tmux(100, 30, script(env, "--log " + recording + (wish == "--mono" ? " --mono" : "")));
    expect_screen(tmux, expected("overview", 100, 30, false));
    const std::string screen = tmux.coloured_screen();
    EXPECT_FALSE(std::regex_search(screen, std::regex("\x1b\\[[0-9;]*3[0-8]"))) << wish;
    EXPECT_TRUE(std::regex_search(screen, std::regex("\x1b\\[[0-9;]*1m"))) << "bold says it";
  }
}

TEST(Terminal, FollowsItsSizeBackAndForth) {
  Tmux tmux(100, 30, script(environment("xterm-256color"), "--log " + recording + " --screen detail"));
  expect_screen(tmux, expected("detail", 100, 30, false));
  const std::pair<int, int> sizes[] = {{80, 24}, {140, 50}, {40, 8},  {7, 3},
                                       {1, 1},   {200, 60}, {20, 40}, {100, 30}};
  for (const auto& [w, h] : sizes) {
    tmux.resize(w, h);
    expect_screen(tmux, expected("detail", w, h, false));
  }
  // faster than it can draw
  for (int i = 0; i < 20; ++i) tmux.resize(60 + 5 * i, 12 + 2 * (i % 7));
  tmux.resize(90, 28);
  expect_screen(tmux, expected("detail", 90, 28, false));
  tmux.keys("q");
  expect_shell_is_back(tmux);
}

class EverySignal : public ::testing::TestWithParam<int> {};

TEST_P(EverySignal, LeavesTheTerminalAsItWas) {
  const int number = GetParam();
  for (const std::string term : {"xterm-256color", "vt100"}) {
    Tmux tmux(80, 24, script(environment(term), "--log " + recording + " --screen detail"));
    expect_screen(tmux, expected("detail", 80, 24, term == "vt100"));
    ASSERT_EQ(kill(pid_in(tmux), number), 0);
    expect_shell_is_back(tmux);
    const bool crash = number == SIGSEGV || number == SIGABRT;
    EXPECT_EQ(read_text(tmux.folder() / "status"), crash ? std::to_string(128 + number) + "\n" : "0\n");
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, EverySignal,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGABRT),
                         [](const auto& kind) { return std::string("SIG") + sigabbrev_np(kind.param); });

TEST(Terminal, CtrlCEndsIt) {
  Tmux tmux(80, 24, script(environment("xterm"), "--log " + recording));
  expect_screen(tmux, expected("overview", 80, 24, false));
  tmux.keys("C-c");
  expect_shell_is_back(tmux);
}

TEST(Terminal, EndsWhenTheTerminalIsGone) {
  pid_t pid = 0;
  {
    Tmux tmux(80, 24, script(environment("xterm"), "--log " + recording));
    expect_screen(tmux, expected("overview", 80, 24, false));
    pid = pid_in(tmux);
    ASSERT_EQ(kill(pid, 0), 0);
  }
  EXPECT_TRUE(until([&] { return kill(pid, 0) != 0; })) << "still running";
}

TEST(Terminal, IsGivenBackWhileSuspendedAndTakenAgain) {
  // an interactive shell, as job control wants one; without its line editor, which has modes of its own
  Tmux tmux(80, 24, "PS1='shell> ' exec bash --norc --noprofile --noediting -i");
  ASSERT_TRUE(until([&] { return tmux.shows("shell>"); }));
  tmux.type("stty -a > before");
  tmux.type(environment("xterm-256color") + program + " --log " + recording);
  const std::string overview = expected("overview", 80, 24, false);
  for (int i = 0; i < 2; ++i) {
    expect_screen(tmux, overview);
    EXPECT_FALSE(tmux.cursor_visible());
    tmux.keys("C-z");
    ASSERT_TRUE(until([&] { return tmux.shows("Stopped"); })) << tmux.screen();
    EXPECT_FALSE(tmux.alternate_screen());
    EXPECT_TRUE(tmux.cursor_visible());
    tmux.type("stty -a > during; echo look at during");
    ASSERT_TRUE(until([&] { return tmux.shows("\nlook at during"); }));
    EXPECT_EQ(modes(tmux.folder() / "during"), modes(tmux.folder() / "before"));
    tmux.type("clear; fg");
  }
  expect_screen(tmux, overview);
  tmux.keys("C-z");
  ASSERT_TRUE(until([&] { return tmux.shows("Stopped"); }));
  tmux.resize(110, 35);  // while detached
  tmux.type("clear; fg");
  expect_screen(tmux, expected("overview", 110, 35, false));
  tmux.keys("q");
  ASSERT_TRUE(until([&] { return !tmux.alternate_screen() && tmux.cursor_visible(); }));
  tmux.type("stty -a > after; echo look at after");
  ASSERT_TRUE(until([&] { return tmux.shows("\nlook at after"); }));
  EXPECT_EQ(modes(tmux.folder() / "after"), modes(tmux.folder() / "before"));
}

}  // namespace egocal

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (!egocal::test::enter_network_namespace()) return 1;
  if (std::system("tmux -V > /dev/null") != 0) {
    std::fprintf(stderr, "these tests need tmux\n");
    return 1;
  }
  const egocal::testing::ScratchFolder folder;
  egocal::scratch = folder.path();
  egocal::recording = egocal::scratch / "scene.log";
  egocal::write_recording();
  return RUN_ALL_TESTS();
}
