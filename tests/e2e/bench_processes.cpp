// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Times of the real processes, and their resources over hours. The numbers are in docs/benchmarks.md.
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/simulation/simulation.hpp"
#include "support/child_process.hpp"
#include "support/network_namespace.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using test::ChildProcess;

const std::string bin = paths::bin_dir();

struct Options {
  int pairs = 4;
  double rate = 100, seconds = 20, warm_up = 5;
  bool spread = false;
  bool monitor = false, state = false;
  std::int64_t motions = 100'000;
  double hours = 2;
  int repeats = 3;
};

struct Setting {
  testing::ScratchFolder scratch;
  std::string folder = scratch.path().string(), rig = scratch.path("rig.toml"),
              url = "udpm://239.255.76.67:7880?ttl=0";
  std::map<std::string, ChildProcess> processes;

  explicit Setting(int sensors) {
    std::ofstream out(rig);
    for (int i = 0; i < sensors; ++i)
      out << "[[sensor]]\nname = \"s" << i << "\"\nchannel = \"S" << i << "\"\n";
    for (int i = 1; i < sensors; ++i) out << "[[pair]]\na = \"s0\"\nb = \"s" << i << "\"\n";
  }
  void start(const std::string& program, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{bin + "/" + program, "--rig", rig, "--lcm-url", url};
    arguments.insert(arguments.end(), more.begin(), more.end());
    processes.emplace(program, ChildProcess(arguments, folder + "/" + program + ".out"));
  }
  void start_all(const Options& options) {
    start("egocal-pairing", options.state ? std::vector<std::string>{"--state", folder + "/state"}
                                          : std::vector<std::string>{});
    start("egocal-fast");
    start("egocal-global");
    if (options.monitor) start("egocal-monitor", {"--follow"});
  }
};

std::vector<Trajectory> drive(int sensors, int poses, double rate) {
  SimulationOptions options;
  options.poses = poses;
  options.rate = rate;
  options.relative_noise = 0.01;
  options.T_vehicle_sensor.clear();
  for (int i = 0; i < sensors; ++i)
    options.T_vehicle_sensor.push_back({rotation_exp({0.3 * i, -0.2, 0.9}), {0.4, -0.8 * i, 0.3}});
  std::vector<Trajectory> trajectories = simulate(options);
  for (Trajectory& trajectory : trajectories)
    for (StampedPose& pose : trajectory) pose.time_us += 1'600'000'000'000'000;
  return trajectories;
}

void print(const char* what, std::vector<std::int64_t> values) {
  if (values.empty()) {
    std::printf("%s: none\n", what);
    return;
  }
  std::sort(values.begin(), values.end());
  const auto part = [&](double p) {
    return static_cast<long long>(values[std::min(
        values.size() - 1, static_cast<std::size_t>(p * static_cast<double>(values.size())))]);
  };
  std::printf("%s: p50 %lld us, p90 %lld us, p99 %lld us, p99.9 %lld us, most %lld us of %zu\n", what,
              part(0.5), part(0.9), part(0.99), part(0.999), static_cast<long long>(values.back()),
              values.size());
}

double processor_seconds(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string field;
  double ticks = 0;
  for (int i = 1; i <= 15 && in >> field; ++i)
    if (i >= 14) ticks += std::stod(field);
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Odometry of all sensors at the given rate; how long until the verified answers are heard.
int latency(const Options& options) {
  const int sensors = options.pairs + 1;
  Setting setting(sensors);
  const int warm_up = static_cast<int>(options.warm_up * options.rate);
  const int poses = static_cast<int>(options.seconds * options.rate) + warm_up;
  const auto trajectories = drive(sensors, poses, options.rate);
  bus::Loop loop(setting.url, bus::LoopOptions{.handle_signals = false});
  std::map<std::string, std::map<std::int64_t, std::int64_t>> sent;  // by sensor b and time
  std::vector<std::int64_t> whole, inside;
  std::int64_t certified = 0, measured = 0;
  bool warm = false;
  for (int i = 1; i < sensors; ++i) {
    const std::string name = "s" + std::to_string(i);
    loop.subscribe<calibration_t>(bus::calibration_channel("s0", name),
                                  [&, name](const calibration_t& answer, const bus::Arrival& arrival) {
                                    const auto at = sent[name].find(answer.utime);
                                    if (!warm || at == sent[name].end() || answer.solver != "egocal-fast")
                                      return;
                                    ++measured;
                                    certified += answer.status == 0;
                                    whole.push_back(arrival.mono_us - at->second);
                                    if (answer.latency_us >= 0) inside.push_back(answer.latency_us);
                                    sent[name].erase(at);
                                  });
  }
  int heard = 0;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t&, const bus::Arrival&) { ++heard; });
  setting.start_all(options);
  while (heard < 3) loop.run_once(10ms);
  const auto period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / options.rate));
  const auto begin = Clock::now() + period;
  const auto wait_until = [&](Clock::time_point time) {
    for (auto now = Clock::now(); now < time; now = Clock::now()) loop.run_once(time - now);
  };
  double used = 0;
  for (int i = 0; i < poses; ++i) {
    if (i == warm_up) {
      warm = true;
      for (const auto& [name, process] : setting.processes) used -= processor_seconds(process.pid());
    }
    for (int k = 0; k < sensors; ++k) {
      wait_until(begin + i * period + (options.spread ? k * period / sensors : 0ns));
      const StampedPose& pose = trajectories[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
      sent["s" + std::to_string(k)][pose.time_us] = bus::mono_us();
      loop.publish("S" + std::to_string(k), bus::to_message(pose, i));
    }
  }
  wait_until(Clock::now() + 200ms);
  for (const auto& [name, process] : setting.processes) used += processor_seconds(process.pid());
  std::printf(
      "%d pairs at %g Hz, %s, %g s; %lld of %lld answers certified, %.1f %% of %d problems answered\n",
      options.pairs, options.rate,
      options.spread ? "sensors spread over the period" : "all sensors at the same instant", options.seconds,
      static_cast<long long>(certified), static_cast<long long>(measured),
      100.0 * static_cast<double>(measured) / (options.pairs * (poses - warm_up)),
      options.pairs * (poses - warm_up));
  print("from sending the message to hearing the answer", whole);
  print("from pairing's receipt to sending the answer", inside);
  std::printf("processor time of our processes: %.0f %% of one core\n", 100 * used / options.seconds);
  return 0;
}

std::int64_t lost_and_matched(const std::string& url, const std::string& b, std::int64_t expected,
                              std::int64_t& lost, std::int64_t& again) {
  bus::Loop loop(url, bus::LoopOptions{.handle_signals = false});
  std::int64_t matched = -1;
  lost = -1;
  again = 0;
  loop.subscribe<problem_t>(
      bus::problem_channel("s0", b),
      [&](const problem_t& problem, const bus::Arrival&) { matched = problem.matched; });
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.role != "pairing") return;
    for (const counter_t& counter : status.counters)
      if (counter.name == "lost")
        lost = counter.value;
      else if (counter.name == "rejected: duplicate")
        again = counter.value;
  });
  const auto end = Clock::now() + 10s;
  while (Clock::now() < end && (lost < 0 || matched < expected)) loop.run_once(10ms);
  return matched;
}

/// A log at full speed through all processes.
int replay(const Options& options) {
  double best = 0;
  bool complete = true;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    Setting setting(2);
    const std::string log = setting.folder + "/drive.log";
    ChildProcess simulate({bin + "/egocal", "simulate", "--out", log, "--poses",
                           std::to_string(options.motions + 1), "--noise", "0.01", "--sensor",
                           "s0=0,0,1.8,1,0,0,0", "--sensor", "s1=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5"});
    if (simulate.wait(300s) != 0) throw std::runtime_error("egocal simulate failed");
    // channels as egocal simulate names them, every step a motion
    std::ofstream(setting.rig)
        << "[[sensor]]\nname = \"s0\"\nchannel = \"ODOMETRY_S0\"\n[[sensor]]\nname = "
           "\"s1\"\nchannel = \"ODOMETRY_S1\"\n[[pair]]\na = \"s0\"\nb = \"s1\"\nstride = 1\n";
    setting.start_all(options);
    std::this_thread::sleep_for(300ms);
    const auto begin = Clock::now();
    ChildProcess player({bin + "/egocal-player", log, "--lcm-url", setting.url, "--speed", "0"},
                        setting.folder + "/player.out");
    const int result = player.wait(600s);
    const std::chrono::duration<double> took = Clock::now() - begin;
    std::int64_t lost = 0, again = 0;
    const std::int64_t matched = lost_and_matched(setting.url, "s1", options.motions, lost, again);
    const double rate = static_cast<double>(options.motions) / took.count();
    std::printf(
        "%lld motion pairs in %.2f s: %.0f a second; player's exit code %d, lost %lld, twice %lld, in the "
        "statistics %lld\n",
        static_cast<long long>(options.motions), took.count(), rate, result, static_cast<long long>(lost),
        static_cast<long long>(again), static_cast<long long>(matched));
    for (const auto& [name, process] : setting.processes)
      std::printf("  %s: %.2f s of a processor\n", name.c_str(), processor_seconds(process.pid()));
    best = std::max(best, rate);
    complete = complete && result == 0 && lost == 0;
  }
  std::printf("best: %.0f motion pairs a second\n", best);
  return complete ? 0 : 1;
}

struct Needs {
  long rss_kb = 0;
  long files = 0;
};
Needs needs(pid_t pid) {
  Needs result;
  std::ifstream in("/proc/" + std::to_string(pid) + "/status");
  std::string line;
  while (std::getline(in, line))
    if (line.starts_with("VmRSS:")) result.rss_kb = std::stol(line.substr(6));
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    static_cast<void>(entry);
    ++result.files;
  }
  return result;
}

/// Hours of driving as fast as it goes: memory and file descriptors stay what they are.
int endurance(const Options& options) {
  Setting setting(3);
  const std::string log = setting.folder + "/drive.log";
  const auto poses = static_cast<std::int64_t>(options.hours * 3600 * options.rate);
  ChildProcess simulate({bin + "/egocal", "simulate", "--out", log, "--rig-out", setting.rig, "--rate",
                         std::to_string(options.rate), "--poses", std::to_string(poses), "--noise", "0.01",
                         "--sensor", "s0=0,0,1.8,1,0,0,0", "--sensor", "s1=1.5,0.2,1.5,0.5,-0.5,0.5,-0.5",
                         "--sensor", "s2=-1.5,0.2,1.5,0.5,0.5,0.5,0.5"});
  if (simulate.wait(600s) != 0) throw std::runtime_error("egocal simulate failed");
  setting.start_all(options);
  std::this_thread::sleep_for(500ms);
  const auto begin = Clock::now();
  setting.processes.emplace(
      "egocal-player", ChildProcess({bin + "/egocal-player", log, "--lcm-url", setting.url, "--speed", "0"}));
  std::map<std::string, Needs> early, most;
  std::vector<std::string> names;
  for (const auto& [name, process] : setting.processes) names.push_back(name);
  int exit_code = -1;
  for (int look = 0; exit_code < 0; ++look) {
    exit_code = setting.processes.at("egocal-player").wait(500ms);
    if (exit_code >= 0) break;
    for (const std::string& name : names) {
      const Needs now = needs(setting.processes.at(name).pid());
      // the first seconds fill queues, histories and blocks
      if (look < 10) {
        early[name].rss_kb = std::max(early[name].rss_kb, now.rss_kb);
        early[name].files = std::max(early[name].files, now.files);
      }
      most[name].rss_kb = std::max(most[name].rss_kb, now.rss_kb);
      most[name].files = std::max(most[name].files, now.files);
    }
  }
  const std::chrono::duration<double> took = Clock::now() - begin;
  std::printf("%.2f hours of three sensors at %g Hz in %.0f s, player's exit code %d\n", options.hours,
              options.rate, took.count(), exit_code);
  bool flat = exit_code == 0;
  for (const std::string& name : names) {
    std::printf("  %-15s most memory in the first 5 s %ld kB, at all %ld kB; file descriptors %ld and %ld\n",
                name.c_str(), early[name].rss_kb, most[name].rss_kb, early[name].files, most[name].files);
    flat = flat && most[name].rss_kb < early[name].rss_kb + 2048 && most[name].files <= early[name].files + 1;
  }
  std::printf(flat ? "flat\n" : "NOT flat\n");
  return flat ? 0 : 1;
}

}  // namespace
}  // namespace egocal

int main(int argc, char** argv) {
  egocal::Options options;
  egocal::cli::Program app("bench_processes", "Measures the real processes over real LCM.");
  app.require_subcommand();
  app.add_flag("--monitor", options.monitor, "with egocal-monitor --follow");
  app.add_flag("--state", options.state, "with a state file");
  egocal::cli::App latency = app.add_subcommand("latency", "from odometry to the verified answer");
  latency.add_option("--pairs", options.pairs).check(egocal::cli::Check::range(1, 64)).show_default();
  latency.add_option("--rate", options.rate, "[Hz] of each sensor").show_default();
  latency.add_option("--seconds", options.seconds).show_default();
  latency.add_option("--warm-up", options.warm_up, "[s] that are not measured").show_default();
  latency.add_flag("--spread", options.spread, "sensors one after the other, not at the same instant");
  egocal::cli::App replay = app.add_subcommand("replay", "a log at full speed");
  replay.add_option("--motions", options.motions).show_default();
  replay.add_option("--repeats", options.repeats).show_default();
  egocal::cli::App endurance =
      app.add_subcommand("endurance", "memory and file descriptors over hours, at full speed");
  endurance.add_option("--hours", options.hours).show_default();
  endurance.add_option("--rate", options.rate, "[Hz] of each sensor").show_default();
  if (const auto code = app.parse(argc, argv)) return *code;
  if (!egocal::test::enter_network_namespace()) return 1;
  try {
    if (latency.given()) return egocal::latency(options);
    if (replay.given()) return egocal::replay(options);
    return egocal::endurance(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_processes: %s\n", error.what());
    return 1;
  }
}
