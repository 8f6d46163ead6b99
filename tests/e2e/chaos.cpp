// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A drive is replayed twice, once undisturbed and once while pairing and solvers are killed at random and
// solvers are swapped: both must end in the same bits. See --help and docs/processes.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/heartbeat.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/online/answer.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "support/random_motion.hpp"
#include "support/scratch_folder.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using test::ChildProcess;

const std::string bin = paths::bin_dir();

struct Options {
  int kills = 100;
  double minutes = 10, rate = 50;
  double kill_distance = 1.2;  // [s] on average
  double within = 1;           // [s] certified again after a restart
  std::uint64_t seed = 1;
  std::string type = "odometry", folder;
};

int failures = 0;
void check(bool condition, const std::string& what) {
  if (condition) return;
  ++failures;
  std::printf("FAILED: %s\n", what.c_str());
}

/// The bus as an observer receives it.
class Observer {
 public:
  Observer(const std::string& url, const std::string& a, const std::string& b)
      : loop_(url, bus::LoopOptions{.handle_signals = false}) {
    loop_.subscribe<problem_t>(bus::problem_channel(a, b), [this](const problem_t& message, const auto&) {
      problem = message;
      problem_at = Clock::now();
    });
    loop_.subscribe<calibration_t>(bus::calibration_channel(a, b),
                                   [this](const calibration_t& message, const auto&) {
                                     answers[message.solver] = message;
                                     if (message.status == 0) certified_at[message.solver] = Clock::now();
                                   });
    loop_.subscribe<status_t>(bus::status_channel, [this](const status_t& message, const auto&) {
      statuses[message.name] = message;
    });
  }
  bool until(const std::function<bool()>& condition, std::chrono::milliseconds timeout) {
    const auto end = Clock::now() + timeout;
    while (!condition()) {
      if (Clock::now() > end) return false;
      loop_.run_once(5ms);
    }
    return true;
  }
  std::int64_t counter(const std::string& process, const std::string& name) {
    for (const counter_t& c : statuses[process].counters)
      if (c.name == name) return c.value;
    return 0;
  }

  std::optional<problem_t> problem;
  Clock::time_point problem_at{};
  std::map<std::string, calibration_t> answers;
  std::map<std::string, Clock::time_point> certified_at;  // by solver
  std::map<std::string, status_t> statuses;

 private:
  bus::Loop loop_;
};

struct Processes {
  std::string rig, url, folder, state;
  std::map<std::string, ChildProcess> running;

  void start(const std::string& program, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{bin + "/" + program, "--rig", rig, "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (program == "egocal-pairing" && !state.empty()) arguments.insert(arguments.end(), {"--state", state});
    running.erase(program);
    running.emplace(program, ChildProcess(arguments, folder + "/" + program + ".out"));
  }
};

struct Result {
  problem_t problem{};
  std::map<std::string, calibration_t> answers;
};

/// The bits of what was accumulated; without what differs from process to process.
std::vector<std::byte> bits(problem_t problem) {
  problem.host.clear();
  problem.received_mono_us = 0;
  return bus::encode(problem);
}

std::vector<std::byte> bits(calibration_t answer) {
  answer.solve_ns = answer.verify_ns = 0;
  answer.latency_us = -1;
  answer.fallback = 0;
  return bus::encode(answer);
}

/// Waits for the end of the replay and for the answers of both solvers to its last problem.
std::optional<Result> end_of(Observer& observer, ChildProcess& player, double timeout_s) {
  const auto timeout = std::chrono::milliseconds(static_cast<int>(1000 * timeout_s));
  if (!observer.until([&] { return observer.statuses["egocal-player"].state == "ended"; }, timeout) ||
      player.wait(5s) != 0)
    return std::nullopt;
  const std::int64_t poses = observer.counter("egocal-player", "out");
  std::printf("  %lld messages sent, of them %lld again\n", static_cast<long long>(poses),
              static_cast<long long>(observer.counter("egocal-player", "sent again")));
  // problems are sent again every second: the same one twice is the last one
  observer.until([] { return false; }, 1200ms);
  const auto answered = [&](const char* solver) {
    return observer.problem && observer.answers.contains(solver) &&
           std::tie(observer.answers[solver].session, observer.answers[solver].seq) ==
               std::tie(observer.problem->session, observer.problem->seq);
  };
  if (!observer.until([&] { return answered("egocal-fast") && answered("egocal-global"); }, 10s))
    return std::nullopt;
  return Result{*observer.problem, observer.answers};
}

std::vector<std::string> random_method(const std::string& program, testing::Random& random) {
  const bool first = random.uniform() < 0.5;
  if (program == "egocal-fast") return {"--method", first ? "sqp" : "slsqp"};
  return {"--always", "--method", first ? "dual" : "sdp"};
}

/// Events of one process in the monitor's lines that say that it was interrupted.
std::map<std::string, std::int64_t> interruptions(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::map<std::tuple<std::string, std::string, std::int64_t>, std::int64_t> events;
  while (std::getline(in, line)) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_discarded()) continue;
    for (const auto& event : json["events"]) {
      const std::string text = event["text"];
      if (text != "process was restarted" && text != "process is back") continue;
      auto& times = events[{event["subject"], text, event["time_us"]}];
      times = std::max<std::int64_t>(times, event["repeated"]);
    }
  }
  std::map<std::string, std::int64_t> sums;
  for (const auto& [key, times] : events) sums[std::get<0>(key)] += times;
  return sums;
}

int run(const Options& options) {
  testing::Random random(options.seed);
  Processes processes;
  processes.folder = options.folder;
  processes.rig = options.folder + "/rig.toml";
  processes.url = "udpm://239.255.76.67:7790?ttl=0";
  const std::string log = options.folder + "/drive.log";
  const int poses = static_cast<int>(60 * options.minutes * options.rate) + 1;
  ChildProcess simulate({bin + "/egocal", "simulate", "--out", log, "--rig-out", processes.rig, "--poses",
                         std::to_string(poses), "--rate", std::to_string(options.rate), "--noise", "0.01",
                         "--type", options.type});
  if (simulate.wait(120s) != 0) {
    std::printf("egocal simulate failed\n");
    return 1;
  }

  std::printf("undisturbed: %d poses of each of two sensors\n", poses);
  std::optional<Result> expected;
  {
    Observer observer(processes.url, "lidar", "camera");
    processes.start("egocal-pairing");
    processes.start("egocal-fast");
    processes.start("egocal-global", {"--always"});
    ChildProcess player({bin + "/egocal-player", log, "--lcm-url", processes.url, "--speed", "0"},
                        options.folder + "/egocal-player.out");
    expected = end_of(observer, player, 120);
    processes.running.clear();
  }
  if (!expected) {
    std::printf("FAILED: the undisturbed replay did not end in answers\n");
    return 1;
  }

  // a busy machine needs this long for a restart; the drive lasts longer than the kills
  const double restart_s = 0.5;
  const double duration = (options.kill_distance + restart_s) * options.kills + 2;
  const double speed = 60 * options.minutes / duration;
  std::printf("disturbed: %d kills in about %.0f s, at %.1f times real time\n", options.kills, duration,
              speed);
  processes.state = options.folder + "/pairing.state";
  Observer observer(processes.url, "lidar", "camera");
  const std::string monitor_file = options.folder + "/monitor.json";
  ChildProcess monitor(
      {bin + "/egocal-monitor", "--follow", "--json", "--rig", processes.rig, "--lcm-url", processes.url},
      monitor_file);
  processes.start("egocal-pairing");
  processes.start("egocal-fast");
  processes.start("egocal-global", {"--always"});
  observer.until([&] { return observer.statuses.size() >= 3; }, 10s);
  ChildProcess player(
      {bin + "/egocal-player", log, "--lcm-url", processes.url, "--speed", std::to_string(speed)},
      options.folder + "/egocal-player.out");
  check(observer.until([&] { return observer.certified_at.size() >= 2; }, 20s),
        "no certified answer to begin with");

  const std::vector<std::string> programs{"egocal-pairing", "egocal-fast", "egocal-global"};
  std::map<std::string, int> kills;
  std::map<std::string, double> longest;
  int while_playing = 0;
  for (int kill = 0; kill < options.kills; ++kill) {
    const double pause = random.uniform(0.2, 1.6) * options.kill_distance * 0.9;
    observer.until([] { return false; }, std::chrono::milliseconds(static_cast<int>(1000 * pause)));
    const std::string program = programs[random.below(3)];
    while_playing += observer.statuses["egocal-player"].state == "running";
    processes.running.erase(program);  // SIGKILL
    ++kills[program];
    observer.until([] { return false; }, std::chrono::milliseconds(static_cast<int>(random.uniform(0, 200))));
    const Clock::time_point restart = Clock::now();
    const std::int64_t old_run = observer.statuses[program].run;
    const bool pairing = program == "egocal-pairing";
    processes.start(program, pairing ? std::vector<std::string>{} : random_method(program, random));
    // certified answers to what pairing sends since, or of the solver itself
    const auto certified = [&] {
      if (observer.statuses[program].run == old_run) return false;
      if (!pairing) return observer.certified_at[program] > restart;
      return observer.problem_at > restart && (observer.certified_at["egocal-fast"] > restart ||
                                               observer.certified_at["egocal-global"] > restart);
    };
    check(observer.until(certified, 10s), program + " restarted: no certified answer within 10 s");
    const std::chrono::duration<double> took = Clock::now() - restart;
    longest[program] = std::max(longest[program], took.count());
  }
  for (const auto& [program, times] : kills)
    std::printf("  %s: killed %d times, certified again after at most %.3f s\n", program.c_str(), times,
                longest[program]);
  for (const auto& [program, seconds] : longest)
    check(seconds <= options.within,
          program + ": certified again only after " + std::to_string(seconds) + " s");
  check(while_playing >= options.kills * 9 / 10,
        "only " + std::to_string(while_playing) + " kills came while the drive was replayed");
  // the last swap: the methods of the undisturbed run
  processes.start("egocal-fast");
  processes.start("egocal-global", {"--always"});
  const std::optional<Result> result = end_of(observer, player, 2 * duration + 60);
  if (!result) {
    std::printf("FAILED: the disturbed replay did not end in answers\n");
    return 1;
  }
  observer.until([] { return false; }, 1500ms);  // the monitor's last line
  monitor.signal(SIGTERM);
  monitor.wait(5s);

  check(bits(result->problem) == bits(expected->problem), "the statistics are not the same bits");
  std::printf("  %lld motion pairs in %zu blocks, session %lld; lost %lld\n",
              static_cast<long long>(result->problem.matched), result->problem.blocks.size(),
              static_cast<long long>(result->problem.session),
              static_cast<long long>(observer.counter("egocal-pairing", "lost")));
  check(result->problem.matched == expected->problem.matched,
        std::to_string(expected->problem.matched) + " motion pairs were expected");
  check(bits(result->answers.at("egocal-global")) == bits(expected->answers.at("egocal-global")),
        "the global answer is not the same bits");
  const auto T_of = [](const calibration_t& answer) {
    return *bus::to_dual_quaternion(answer.pos, answer.quat).value;
  };
  const ExtrinsicError fast =
      extrinsic_error(T_of(expected->answers.at("egocal-fast")), T_of(result->answers.at("egocal-fast")));
  std::printf("  warm-started answer: %.1e m and %.1e rad from the undisturbed one\n", fast.translation,
              fast.rotation);
  check(fast.translation <= 1e-12 && fast.rotation <= 1e-12, "the warm-started answer differs");
  auto seen = interruptions(monitor_file);
  for (const auto& [program, times] : kills) {
    std::printf("  %s: %lld of %d interruptions in the monitor's events\n", program.c_str(),
                static_cast<long long>(seen[program]), times);
    check(seen[program] >= times, program + ": an interruption is not in the monitor's events");
  }
  std::printf(failures == 0 ? "the same\n" : "NOT the same\n");
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace egocal

int main(int argc, char** argv) {
  egocal::Options options;
  egocal::cli::Program app(
      "egocal_chaos",
      "Replays a drive undisturbed, then again while processes are killed with SIGKILL and solvers are "
      "swapped "
      "at random, and compares the bits.");
  app.add_option("--kills", options.kills).check(egocal::cli::Check::range(1, 100000)).show_default();
  app.add_option("--minutes", options.minutes, "length of the drive").show_default();
  app.add_option("--rate", options.rate, "poses a second of each sensor").show_default();
  app.add_option("--kill-distance", options.kill_distance, "[s] on average").show_default();
  app.add_option("--within", options.within, "[s] until certified again after a restart").show_default();
  app.add_option("--seed", options.seed).show_default();
  app.add_option("--type", options.type, "of the messages: odometry or pose (without numbers)")
      .check(egocal::cli::Check::one_of({"odometry", "pose"}))
      .show_default();
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!egocal::test::enter_network_namespace()) return 1;
  egocal::testing::ScratchFolder scratch;
  options.folder = scratch.path().string();
  int result = 1;
  try {
    result = egocal::run(options);
  } catch (const std::exception& error) {
    std::printf("FAILED: %s\n", error.what());
  }
  if (result != 0) {
    scratch.keep();
    std::printf("outputs are in %s\n", options.folder.c_str());
  }
  return result;
}
