// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands/commands.hpp"
#include "egocal/bus/log_file.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "supervision/output_file.hpp"
#include "supervision/supervisor.hpp"

namespace egocal::tools {

namespace {

struct Options {
  std::string rig, log, url, output_dir, state, speed = "1", fast = "sqp", global = "dual";
  bool monitor = false, follow = false;
};

/// The folder of our own executable: the other programs lie beside it.
std::filesystem::path programs_directory() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw Error("up: cannot find out where this program lies: " + error.message());
  return self.parent_path();
}

/// Of pairing, for the process that takes its place while this command runs.
std::string passing_state(const std::string& directory, pid_t pid) {
  return fmt::format("{}/pairing-{}.state", directory, pid);
}

void remove_passing_state(const std::string& directory, pid_t pid) {
  for (const char* suffix : {"", ".lock", ".part"})
    std::filesystem::remove(passing_state(directory, pid) + suffix);
}

/// Those of commands that were killed.
void remove_stale_states(const std::string& directory) {
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    int pid = 0;
    if (std::sscanf(entry.path().filename().c_str(), "pairing-%d.state", &pid) == 1 && pid > 0 &&
        kill(pid, 0) != 0 && errno == ESRCH)
      remove_passing_state(directory, pid);
  }
}

void run(const Options& options) {
  // one clear line here instead of one from each process
  const bus::Rig rig = bus::read_rig(options.rig);
  if (!options.log.empty()) bus::LogReader{options.log};
  bus::Loop{options.url.empty() ? rig.lcm_url : options.url, bus::LoopOptions{.handle_signals = false}};
  const std::filesystem::path directory = programs_directory();
  SupervisorOptions supervisor;
  if (options.output_dir != "-") {
    const std::string rig_name = std::filesystem::path(options.rig).stem();
    supervisor.output_dir =
        options.output_dir.empty() ? default_output_directory() + "/" + rig_name : options.output_dir;
    std::error_code error;
    std::filesystem::create_directories(supervisor.output_dir, error);
    if (error) throw error_at(supervisor.output_dir, 0, "", "cannot be made: " + error.message());
    fmt::print(stderr, "egocal up: the processes' outputs are in {}\n", supervisor.output_dir);
  }
  supervisor.quiet = options.monitor;

  const auto program = [&](const char* name, const std::vector<std::string>& more) {
    Program result;
    result.name = name;
    result.command = {(directory / name).string(), "--rig", options.rig};
    if (!options.url.empty()) result.command.insert(result.command.end(), {"--lcm-url", options.url});
    result.command.insert(result.command.end(), more.begin(), more.end());
    return result;
  };
  // what a killed pairing process had accumulated is for the one that takes its place; for another day only
  // if asked for
  std::vector<std::string> pairing;
  const bool passing = options.state.empty() && !supervisor.output_dir.empty();
  if (passing) {
    remove_stale_states(supervisor.output_dir);
    remove_passing_state(supervisor.output_dir, getpid());
    pairing = {"--state", passing_state(supervisor.output_dir, getpid())};
  } else if (!options.state.empty()) {
    pairing = {"--state", options.state};
  }
  std::vector<Program> programs = {program("egocal-pairing", pairing),
                                   program("egocal-fast", {"--method", options.fast}),
                                   program("egocal-global", {"--method", options.global})};
  if (options.monitor || options.follow) {
    programs.push_back(program("egocal-monitor", options.follow ? std::vector<std::string>{"--follow"}
                                                                : std::vector<std::string>{}));
    programs.back().foreground = true;
  }
  if (!options.log.empty()) {
    programs.push_back(program("egocal-player", {options.log, "--speed", options.speed}));
    programs.back().ends_all = true;
  }
  const int code = supervise(programs, supervisor);
  if (passing) remove_passing_state(supervisor.output_dir, getpid());
  if (code != 0) throw cli::Exit{1};
}

}  // namespace

void add_up(cli::App program) {
  const auto options = std::make_shared<Options>();
  cli::App command = program.add_subcommand("up", "all processes of a rig, kept alive and ended together");
  command.add_option("RIG", options->rig, "rig file").required();
  command.add_option("--log", options->log, "also plays this log; at its end all end");
  command.add_option("--speed", options->speed, "of the player; 0: as fast as possible")
      .check(cli::Check::not_negative())
      .show_default();
  command.add_option("--fast", options->fast, "fast solver")
      .check(cli::Check::one_of({"sqp", "slsqp"}))
      .show_default();
  command.add_option("--global", options->global, "global solver")
      .check(cli::Check::one_of({"dual", "sdp"}))
      .show_default();
  command.add_flag("--monitor", options->monitor, "with the monitor on this terminal; all end with it");
  command.add_flag("--follow", options->follow, "with the monitor's lines on standard output");
  command.add_option(
      "--output-dir", options->output_dir,
      "each process's output in a file there; -: here; default: ~/.local/state/egocal/NAME OF RIG");
  command.add_option("--state", options->state, "file in which the statistics outlive this command");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.callback([options] { run(*options); });
}

}  // namespace egocal::tools
