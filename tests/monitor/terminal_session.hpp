// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The real monitor in a real terminal (tmux), and what the two tests of it share.
#pragma once

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
#include "tmux.hpp"

namespace egocal {

using monitor::test::begin_utime;
using monitor::test::calibration_at;
using monitor::test::problem_at;
using monitor::test::status_of;
using test::Output;
using test::output_of;
using test::read_text;
using test::Tmux;
using test::trimmed;
using test::until;
using ::testing::HasSubstr;

inline const std::string program = paths::bin_dir() + "/egocal-monitor";
inline const std::string feeder = paths::test_dir() + "/egocal-monitor-feeder";
inline std::filesystem::path scratch;  // of this run, with the recorded session in it
inline std::string recording;

inline const std::string evil_name = "\x1b[2J\x1b]0;owned\x07\xff" + std::string(120, 'W');

// Twenty seconds of two well-behaved pairs and a hostile one: the same on every machine.
inline void write_recording() {
  bus::LogWriter log(recording);
  for (std::int64_t step = 0; step < 200; ++step) {
    const std::int64_t now = begin_utime + step * 100'000;
    for (const std::string b : {"camera", "radar", "evil"}) {
      problem_t problem = problem_at("lidar", b, step, 10, 4);
      calibration_t fast = calibration_at(problem, false), global = calibration_at(problem, true);
      if (b == "evil") {
        problem.sensor_a = fast.sensor_a = global.sensor_a = evil_name;
        fast.pos[1] = fast.scaled_gap = std::numeric_limits<double>::quiet_NaN();
        fast.hint = evil_name;
      }
      log.write(now, "EGOCAL_PROBLEM_lidar_" + b, bus::encode(problem));
      log.write(now + 300, "EGOCAL_CALIBRATION_lidar_" + b, bus::encode(fast));
      if (step < 50) log.write(now + 400, "EGOCAL_CALIBRATION_lidar_" + b, bus::encode(global));
    }
    if (step % 10 == 0)
      for (const char* role : {"player", "pairing", "global", "fast"}) {
        status_t status = status_of(std::string("egocal-") + role, role, step * 3);
        if (step == 150 && std::string(role) == "global") status.state = "ended";
        if (step > 150 && std::string(role) == "global") continue;
        log.write(now + 500, bus::status_channel, bus::encode(status));
      }
  }
  log.close();
}

inline std::string environment(const std::string& term, const std::string& locale = "C.UTF-8") {
  return "env -u NO_COLOR -u LANG -u LC_CTYPE TZ=UTC0 TERM=" + term + " LC_ALL=" + locale + " ";
}

// What the screen has to show: the same canvas, printed without a terminal.
inline std::string expected(const std::string& screen, int width, int height, bool ascii) {
  const Output output = output_of(environment("dumb") + program + " --log " + recording +
                                  " --once --screen " + screen + " --size " + std::to_string(width) + "x" +
                                  std::to_string(height) + (ascii ? " --ascii" : ""));
  EXPECT_EQ(output.status, 0);
  return trimmed(output.text);
}

// The monitor between two looks at the terminal's state; its pid and exit code are left in files.
inline std::string script(const std::string& env, const std::string& arguments) {
  return "trap : INT\nstty -a > before\n"
         "sh -c 'echo $$ > pid; exec " +
         env + program + " " + arguments +
         "'\n"
         "echo $? > status\nstty -a > after\necho the shell is back\nread line\n";
}

inline pid_t pid_in(const Tmux& tmux) {
  std::string pid;
  if (!until([&] { return (pid = read_text(tmux.folder() / "pid")).ends_with('\n'); }))
    throw std::runtime_error("the monitor was not started");  // and 0 would be this process, too
  return static_cast<pid_t>(std::stol(pid));
}

inline void expect_screen(const Tmux& tmux, const std::string& text) {
  std::string seen;
  until([&] { return (seen = tmux.screen()) == text; });
  EXPECT_EQ(seen, text);
}

// What `stty -a` said, except for the size, which is not ours to keep.
inline std::string modes(const std::filesystem::path& file) {
  return std::regex_replace(read_text(file), std::regex("rows [0-9]+; columns [0-9]+; "), "");
}

inline void expect_shell_is_back(const Tmux& tmux) {
  ASSERT_TRUE(until([&] { return tmux.shows("the shell is back"); })) << tmux.screen();
  const std::string before = modes(tmux.folder() / "before");
  EXPECT_THAT(before, HasSubstr("icanon"));
  EXPECT_EQ(modes(tmux.folder() / "after"), before);
  EXPECT_FALSE(tmux.alternate_screen());
  EXPECT_TRUE(tmux.cursor_visible());
  EXPECT_EQ(tmux.ask("#{keypad_flag}#{keypad_cursor_flag}"), "00");
  // no colour or weight is left behind
  std::istringstream lines(tmux.coloured_screen());
  for (std::string line; std::getline(lines, line);) {
    if (line.find("the shell is back") != std::string::npos) {
      EXPECT_EQ(line, "the shell is back");
    }
  }
}

}  // namespace egocal
