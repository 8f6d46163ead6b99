// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The program itself, and drives of three sensors on one body.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/file_content.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::testing {

class RigCommand : public ::testing::Test {
 protected:
  struct Result {
    int code = -1;
    std::string out, error;
    nlohmann::json object() const { return nlohmann::json::parse(out); }
  };
  Result run(const std::string& arguments) {
    const std::string out = folder.path("out"), error = folder.path("err");
    const int status =
        std::system((paths::bin_dir() + "/egocal " + arguments + " >" + out + " 2>" + error).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(error)};
  }
  /// lidar, camera and radar in free motion; their three files.
  std::string rig(const std::string& name, const std::string& options = "", int poses = 700,
                  const std::string& terrain = "free") {
    const Result result = run("simulate --terrain " + terrain + " --noise 0.01 --out " + folder.path(name) +
                              " --poses " + std::to_string(poses) + sensors + options);
    EXPECT_EQ(result.code, 0) << result.error;
    std::string files;
    for (const char* sensor : {"lidar", "camera", "radar"})
      files += " " + folder.path(name) + "/" + sensor + ".tum";
    return files;
  }

  const std::string sensors =
      " --sensor lidar=0,0,1.8,1,0,0,0 --sensor camera=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5 --sensor "
      "radar=2,0,0.5,1,0,0,0 ";
  ScratchFolder folder;
};

inline std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Of a file of poses, those from one time to another [s] from its begin.
inline std::string part_of(const ScratchFolder& folder, const std::string& file, const std::string& name,
                           double from, double to) {
  std::ifstream all(file);
  std::ofstream part(folder.path(name));
  double begin = -1;
  for (std::string line; std::getline(all, line);) {
    if (line.empty() || line[0] == '#') continue;
    const double time = std::stod(line);
    if (begin < 0) begin = time;
    if (time - begin >= from && time - begin <= to) part << line << "\n";
  }
  return folder.path(name);
}

}  // namespace egocal::testing
