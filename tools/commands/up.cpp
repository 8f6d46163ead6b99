// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "answers/answers.hpp"
#include "commands/commands.hpp"
#include "commands/report.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/io/whole_file.hpp"
#include "offline/reading/log_channels.hpp"
#include "offline/rig/pair_request.hpp"
#include "supervision/bus_watch.hpp"
#include "supervision/interruptions.hpp"
#include "supervision/output_file.hpp"
#include "supervision/passing_state.hpp"
#include "supervision/rig_copy.hpp"
#include "supervision/supervisor.hpp"
#include "supervision/usable_state.hpp"
#include "warnings.hpp"

namespace egocal::tools {

namespace {

struct UpOptions {
  std::string rig, log, url, output_dir, state, speed = "1", fast = "sqp", global = "dual";
  bool monitor = false, follow = false, join = false, report = false;
};

/// Every process sends its status once a second.
constexpr std::chrono::milliseconds listen_before_start{1200};

void report(const std::string& line) {
  say("egocal up: " + line);
}

/// Throws Error where the reader of a pipe has gone, or the device takes nothing.
void require_output() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  if ((poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLNVAL)) != 0) || write(STDOUT_FILENO, "", 0) < 0)
    throw Error("standard output is gone: the monitor's lines cannot be written, and without it all end");
}

/// The folder of our own executable: the other programs are beside it.
std::filesystem::path programs_directory() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw Error("cannot find the folder of this program: " + error.message());
  return self.parent_path();
}

/// Checks where the state is to be kept: one clear line here instead of one from each process, again and
/// again.
void check_place_of_state(const std::string& file) {
  const std::filesystem::path target(without_links(file)), folder = target.parent_path();
  std::error_code none;
  if (!std::filesystem::is_directory(folder, none))
    throw error_at(file, 0, "--state", "the folder " + folder.string() + " is not there");
  if (std::filesystem::exists(target, none) && !std::filesystem::is_regular_file(target, none))
    throw error_at(file, 0, "--state", "is there and is not a file");
  if (access(folder.c_str(), W_OK) != 0)
    throw error_at(file, 0, "--state", "cannot be written: " + std::string(std::strerror(errno)));
}

void check_state(const std::string& file) {
  require_usable_state(file, "egocal-pairing");
  require_usable_state(PassingState::of_diagnosis(file), "egocal-diagnosis");
}

std::string output_directory(const UpOptions& options) {
  if (options.output_dir == "-") return {};
  std::string directory = options.output_dir.empty() ? default_output_directory() + "/" +
                                                           std::filesystem::path(options.rig).stem().string()
                                                     : options.output_dir;
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw error_at(directory, 0, "", "cannot be made: " + error.message());
  report("the processes' outputs are in " + directory);
  return directory;
}

void report_left_behind(const std::string& directory) {
  const std::vector<std::string> files = PassingState::left_behind(directory);
  if (files.empty()) return;
  report(
      fmt::format("statistics of an earlier run that did not end as it should are kept in {}{}; --state FILE "
                  "continues with them, delete what is not needed",
                  files.back(), files.size() > 1 ? " and " + counted(files.size() - 1, "other") : ""));
}

/// Writes one page a pair, from the log and the rig's settings, beside the processes' outputs. What cannot be
/// solved offline is named; the answer of the processes remains. False: a page says that its answer should
/// not be used. A page knows all poses, the diagnosis 1200 of the slower stream, so their verdicts may
/// differ.
bool write_reports(const UpOptions& options, const bus::Rig& rig, const std::string& directory) {
  bool usable = true;
  for (const bus::PairConfig& pair : rig.pairs) {
    const std::string file = fmt::format("{}/report-{}-{}.html", directory, pair.a, pair.b);
    try {
      const ReportInput page =
          write_report(request_of_pair(rig, pair, options.log), file,
                       fmt::format("egocal up {} --log {} --report", options.rig, options.log));
      report(file + ": " + page.verdict);
      usable = usable && page.calibration.verdict != Verdict::contradictory;
    } catch (const Error& error) {
      report(fmt::format("no report of {} and {}: {}", pair.a, pair.b, error.what()));
    }
  }
  return usable;
}

/// Checks what can be known before any process is started.
void check_before_start(const UpOptions& options, const bus::Rig& rig, const std::string& url) {
  for (const bus::PairConfig& pair : rig.pairs) static_cast<void>(bus::drive_options(rig, pair));
  if (options.follow) require_output();
  if (!options.log.empty()) require_a_pair(options.log, rig);
  if (!options.state.empty()) check_place_of_state(options.state);
  const std::optional<std::string> other = pairing_heard(url, listen_before_start);
  if (other && !options.join)
    throw Error(*other + " is running on " + url +
                ": the two would disturb each other; end the other one, take another --lcm-url, or --join");
  if (!options.state.empty()) check_state(options.state);
}

/// The programs to start. state: the state file of pairing; empty: it keeps none.
std::vector<Program> programs_of(const UpOptions& options, const std::string& rig, const std::string& state) {
  const std::filesystem::path directory = programs_directory();
  const auto program = [&](const char* name, const std::vector<std::string>& more) {
    Program result;
    result.name = name;
    result.command = {(directory / name).string(), "--rig", rig};
    if (!options.url.empty()) result.command.insert(result.command.end(), {"--lcm-url", options.url});
    result.command.insert(result.command.end(), more.begin(), more.end());
    return result;
  };
  std::vector<std::string> pairing, diagnosis;
  if (!state.empty()) {
    pairing = {"--state", state};
    diagnosis = {"--state", PassingState::of_diagnosis(state)};
  }
  std::vector<Program> programs = {
      program("egocal-pairing", pairing), program("egocal-fast", {"--method", options.fast}),
      program("egocal-global", {"--method", options.global}), program("egocal-diagnosis", diagnosis)};
  if (options.monitor || options.follow) {
    programs.push_back(program("egocal-monitor", options.follow ? std::vector<std::string>{"--follow"}
                                                                : std::vector<std::string>{}));
    programs.back().foreground = true;
  }
  if (!options.log.empty()) {
    // pairing is started again until it works: nothing of the log is played without it
    programs.push_back(
        program("egocal-player", {options.log, "--speed", options.speed, "--wait-for-pairing", "1e9"}));
    programs.back().ends_all = true;
  }
  return programs;
}

/// Prints what was calibrated by the end of the log. Throws where that is nothing, or where no answer can be
/// used.
void conclude(const UpOptions& options, const bus::Rig& rig, BusWatch& watch, const std::string& output_dir,
              bool monitor_ended) {
  const Outcome outcome = [&] {
    try {
      return watch.outcome();
    } catch (const Error& error) {
      throw Error(fmt::format("{}; egocal solve --rig {} --log {} computes it from the log", error.what(),
                              options.rig, options.log));
    }
  }();
  if (!outcome.answered && monitor_ended)
    throw Error("nothing was calibrated: the monitor was ended, and with it all others");
  if (!outcome.answered)
    throw Error("nothing was calibrated: " + (outcome.text.empty() ? "no solver answered" : outcome.text) +
                "; see " + (output_dir.empty() ? "above" : output_dir));
  fmt::print("{}", outcome.text);
  const bool pages_usable =
      !options.report || write_reports(options, rig, output_dir.empty() ? "." : output_dir);
  if (outcome.unusable || !pages_usable) throw cli::Exit{not_to_be_used};
}

void run(const UpOptions& options, Interruptions& interruptions) {
  if (options.report && options.log.empty())
    throw cli::UsageError("--report: goes with --log, whose drive it shows");
  const RigCopy copy(options.rig);
  const bus::Rig& rig = copy.rig();
  const std::string url = options.url.empty() ? rig.lcm_url : options.url;
  check_before_start(options, rig, url);
  SupervisorOptions supervisor;
  supervisor.output_dir = output_directory(options);
  supervisor.quiet = options.monitor;
  BusWatchOptions watched;
  watched.news.live = options.log.empty();
  BusWatch watch(rig, url, options.log, watched);
  interruptions.hold();  // what is left behind from here on is to be removed
  // what a killed pairing process had accumulated is for the one that takes its place; for another day only
  // if asked for
  std::optional<PassingState> passing;
  if (options.state.empty() && !supervisor.output_dir.empty()) {
    report_left_behind(supervisor.output_dir);
    passing.emplace(supervisor.output_dir);
  }
  supervisor.heard_ago = [&watch](pid_t pid) { return watch.silence(pid); };
  supervisor.may_be_silent = [&watch](pid_t pid) { return watch.announced_silence(pid); };
  supervisor.lines = watch.lines();
  supervisor.lines_again = [&watch] { return watch.listen_again(); };
  if (!options.log.empty()) {
    supervisor.awaited = [&watch] { return watch.awaited(); };
    supervisor.counts_awaited = [&watch] { return watch.pid(); };
  }
  bool monitor_ended = false;
  supervisor.foreground_ended = [&monitor_ended] { monitor_ended = true; };
  const int code = supervise(
      programs_of(options, copy.name_for_programs(), passing ? passing->file() : options.state), supervisor);
  interruptions.release();
  if (code == 0 && passing) passing->discard();
  if (code != 0) {
    if (passing && std::filesystem::exists(passing->file()))
      report("the statistics are kept in " + passing->file() + "; --state FILE continues with them");
    throw cli::Exit{1};
  }
  if (options.follow && monitor_ended) require_output();
  if (!options.log.empty()) conclude(options, rig, watch, supervisor.output_dir, monitor_ended);
}

void run_up(const UpOptions& options) {
  Interruptions interruptions(!options.log.empty());
  try {
    run(options, interruptions);
  } catch (const Error& error) {
    report(error.what());
    throw cli::Exit{1};
  }
}

}  // namespace

void add_up(cli::App program) {
  const auto options = std::make_shared<UpOptions>();
  cli::App command = program.add_subcommand("up", "all processes of a rig, kept alive and ended together");
  command.add_option("RIG", options->rig, "rig file").required();
  const cli::Option log =
      command.add_option("--log", options->log, "also plays this log; at its end all end");
  command.add_option("--speed", options->speed, "of the player; 0: as fast as possible")
      .check(cli::Check::range(0.0, 1e6))
      .show_default()
      .needs(log);
  command.add_option("--fast", options->fast, "fast solver")
      .check(cli::Check::one_of({"sqp", "slsqp"}))
      .show_default();
  command.add_option("--global", options->global, "global solver")
      .check(cli::Check::one_of({"dual", "sdp"}))
      .show_default();
  const cli::Option monitor =
      command.add_flag("--monitor", options->monitor, "with the monitor on this terminal; all end with it");
  command.add_flag("--follow", options->follow, "with the monitor's lines on standard output")
      .excludes(monitor);
  command.add_option(
      "--output-dir", options->output_dir,
      "each process's output in a file there; -: here; default: ~/.local/state/egocal/NAME OF RIG");
  command.add_flag("--report", options->report,
                   "with --log: a page of each pair (egocal report) in the output folder, made at the end");
  command.add_flag("--join", options->join, "also where pairing is running on this bus already");
  command.add_option("--state", options->state, "file in which the statistics outlive this command");
  command.add_option("--lcm-url", options->url, "LCM URL instead of the rig's");
  command.callback([options] { run_up(*options); });
}

}  // namespace egocal::tools
