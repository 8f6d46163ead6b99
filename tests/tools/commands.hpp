// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test {

/// What a program said.
struct Outcome {
  int code = -1;
  std::string out, err;
};

/// The real programs on real files, in a folder of the test.
class Commands : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string file(const std::string& name, const std::string& content) const {
    return folder_.file(name, content);
  }
  static std::string read(const std::string& name) {
    std::ifstream stream(name, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  Outcome program(const std::string& name, const std::string& arguments) const {
    const std::string command =
        paths::bin_dir() + "/" + name + " " + arguments + " >" + path("out") + " 2>" + path("err");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(path("out")), read(path("err"))};
  }
  Outcome egocal(const std::string& arguments) const { return program("egocal", arguments); }
  nlohmann::json solved(const std::string& arguments) const {
    const Outcome run = egocal("solve --json " + arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return nlohmann::json::parse(run.out);
  }
  /// One line that says it, nothing on standard output.
  static void expect_refusal(const Outcome& run, int code, const std::string& part) {
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, ::testing::HasSubstr(part));
  }

 private:
  testing::ScratchFolder folder_;
};

inline std::string tum(int poses, const std::function<std::string(int)>& pose) {
  std::string text;
  for (int i = 0; i < poses; ++i) text += std::to_string(1000 + 0.1 * i) + " " + pose(i) + "\n";
  return text;
}

/// A pose of a TUM file.
inline const std::string good_line = "1000.0 0 0 0 0 0 0 1\n";

}  // namespace egocal::test
