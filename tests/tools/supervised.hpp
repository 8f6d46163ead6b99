// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Processes that fail, hang, or are ended: small scripts under the supervisor.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "egocal/error.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"
#include "support/child_process.hpp"
#include "support/paths.hpp"

namespace egocal::test {

using namespace std::chrono_literals;
using tools::Program;
using tools::SupervisorOptions;

inline bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout = 30s) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

inline std::string read(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::vector<std::string> lines(const std::string& file) {
  std::istringstream stream(read(file));
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

inline bool runs(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(") ");
  return name_end != std::string::npos && text[name_end + 2] != 'Z' && text[name_end + 2] != 'X';
}

/// Process ids and names of the children of a process.
inline std::vector<std::pair<pid_t, std::string>> children(pid_t parent) {
  std::vector<std::pair<pid_t, std::string>> result;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); })) continue;
    std::string text;  // empty where the process has just ended
    std::getline(std::ifstream(entry.path() / "stat"), text);
    const std::size_t open = text.find('('), close = text.rfind(") ");
    if (open == std::string::npos || close == std::string::npos) continue;
    char state = 0;
    pid_t ppid = 0;
    std::istringstream(text.substr(close + 2)) >> state >> ppid;
    if (ppid == parent && state != 'Z')
      result.emplace_back(std::stoi(name), text.substr(open + 1, close - open - 1));
  }
  return result;
}

class Supervision : public ::testing::Test {
 protected:
  Supervision() {
    static int number = 0;
    folder = std::filesystem::temp_directory_path() /
             ("egocal-up-" + std::to_string(getpid()) + "-" + std::to_string(++number));
    std::filesystem::create_directories(folder);
    options.output_dir = folder;
    options.restarts.first_back_off = 50ms;
    options.restarts.longest_back_off = 400ms;
    options.settle = 100ms;
  }
  ~Supervision() override {
    if (pid > 0) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
    // what a killed supervisor had started writes for a moment longer
    until([&] {
      std::error_code still_written;
      std::filesystem::remove_all(folder, still_written);
      return !still_written;
    });
  }
  std::string path(const std::string& name) const { return folder / name; }

  /// A shell script; $F is the folder.
  Program script(const std::string& name, const std::string& text) const {
    Program program;
    program.name = name;
    program.command = {"/bin/sh", "-c", "F=" + folder.string() + "\n" + text};
    return program;
  }
  /// A script that waits for a signal, and writes each one down.
  Program waiting(const std::string& name, const std::string& ending = "exit 0") const {
    return script(name, "trap 'echo INT >>$F/" + name + ".signals; " + ending +
                            "' INT\ntrap 'echo TERM >>$F/" + name + ".signals; " + ending +
                            "' TERM\necho $$ >>$F/" + name + ".pids\nwhile :; do sleep 0.05; done");
  }
  void start(const std::vector<Program>& programs) {
    pid = fork();
    if (pid != 0) return;
    if (!std::freopen(path("said").c_str(), "a", stderr)) _exit(99);
    std::setvbuf(stderr, nullptr, _IONBF, 0);  // as standard error is
    int code = 98;
    try {
      code = tools::supervise(programs, options);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      code = 97;
    }
    std::fflush(stderr);
    _exit(code);
  }
  int ended(std::chrono::milliseconds within = 30s) {
    int state = 0;
    if (!until([&] { return waitpid(pid, &state, WNOHANG) == pid; }, within)) return -1;
    pid = -1;
    return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  }
  /// The process that runs under this name, once that many have been started.
  pid_t process(const std::string& name, std::size_t starts = 1) const {
    EXPECT_TRUE(until([&] { return lines(path(name + ".pids")).size() >= starts; })) << name;
    const auto pids = lines(path(name + ".pids"));
    return pids.size() < starts ? -1 : std::stoi(pids[starts - 1]);
  }

  std::filesystem::path folder;
  SupervisorOptions options;
  pid_t pid = -1;
};

}  // namespace egocal::test
