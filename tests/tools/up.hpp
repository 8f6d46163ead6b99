// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal up` with the real processes, each on a small simulated drive and a bus of its own.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "supervised.hpp"
#include "support/child_process.hpp"
#include "support/paths.hpp"

namespace egocal::test {

class Up : public Supervision {
 protected:
  Up() : rig(path("drive.toml")), log(path("drive.log")) {
    const int code = ChildProcess({paths::bin_dir() + "/egocal", "simulate", "--out", log, "--rig-out", rig,
                                   "--poses", "400", "--noise", "0.001"})
                         .wait(60s);
    EXPECT_EQ(code, 0);
  }
  ChildProcess up(std::vector<std::string> more) const {
    static int port = 7780;
    std::vector<std::string> arguments{paths::bin_dir() + "/egocal",
                                       "up",
                                       rig,
                                       "--output-dir",
                                       path("out"),
                                       "--lcm-url",
                                       "udpm://239.255.76.67:" + std::to_string(++port) + "?ttl=0"};
    if (std::find(more.begin(), more.end(), "--lcm-url") != more.end())
      arguments.resize(arguments.size() - 2);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ChildProcess(arguments, path("said"));
  }
  static pid_t child(pid_t parent, const std::string& name) {
    for (const auto& [pid, its_name] : children(parent))
      if (its_name == name) return pid;
    return -1;
  }
  /// All of these run; /proc knows the first 15 characters of a name.
  static bool all_run(pid_t parent, const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(),
                       [&](const std::string& name) { return child(parent, name.substr(0, 15)) > 0; });
  }
  /// A file takes the place of a folder, which is kept as `away`, in one step: a process that saves its state
  /// makes a folder that is missing again.
  void take_away(const std::string& place, const std::string& away) const {
    std::ofstream(away) << "no folder\n";
    ASSERT_EQ(renameat2(AT_FDCWD, place.c_str(), AT_FDCWD, away.c_str(), RENAME_EXCHANGE), 0);
  }
  const std::vector<std::string> calibrating{"egocal-pairing", "egocal-fast", "egocal-global",
                                             "egocal-diagnosis"};

  std::string rig, log;
};

}  // namespace egocal::test
