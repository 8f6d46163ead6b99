// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// egocal_simulation: all processes in virtual time, one life per seed (docs/simulation.md).
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "egocal/cli/cli.hpp"
#include "egocal/error.hpp"
#include "simulation/shrink.hpp"

using namespace egocal;
using namespace egocal::simulation;

namespace {

struct Options {
  std::uint64_t seed = 1, seeds = 1;
  double minutes = 0;
  bool twice = false, story = false, everything = false, no_shrink = false, until_failure = false;
  std::string corpus, resume;
};

/// Progress of a long run, in a file: `next seed, lives, violations, trace`.
struct Progress {
  std::uint64_t seed = 1, lives = 0, failed = 0, trace = 0;
};

bool read(const std::string& file, Progress& progress) {
  std::ifstream in(file);
  return static_cast<bool>(in >> progress.seed >> progress.lives >> progress.failed >> std::hex >>
                           progress.trace);
}

void write_to(const std::string& file, const Progress& progress) {
  std::ofstream out(file + ".new");
  out << progress.seed << ' ' << progress.lives << ' ' << progress.failed << ' ' << std::hex << progress.trace
      << '\n';
  out.close();
  if (!out || std::rename((file + ".new").c_str(), file.c_str()) != 0)
    throw error_at(file, 0, "", "cannot be written");
}

volatile std::sig_atomic_t asked_to_end = 0;

/// What services write for people is discarded, and no keys are typed.
void silence_services() {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null < 0) return;
  dup2(null, STDERR_FILENO);
  dup2(null, STDIN_FILENO);
}

/// Longest processor time of a life [s], which takes milliseconds. A longer one would never end.
constexpr int longest_life_s = 20;

char hang_text[80];

/// Names the seed and ends the program, as the code of the processes cannot be interrupted.
void on_hang(int) {
  if (write(STDOUT_FILENO, hang_text, std::strlen(hang_text)) < 0) _exit(2);
  _exit(1);
}

void watch(std::uint64_t seed) {
  std::snprintf(hang_text, sizeof hang_text, "seed %" PRIu64 ": (g) the life hangs\n", seed);
  std::signal(SIGPROF, on_hang);
  const itimerval limit{{0, 0}, {longest_life_s, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

void tell_story(const Plan& plan, bool everything) {
  live(plan, {.tell = [](const std::string& line) { std::printf("%s\n", line.c_str()); },
              .everything = everything});
}

void report(const Plan& plan, const Violation& violation, bool shrinks, bool everything) {
  std::printf("seed %" PRIu64 ": (%c) at %.6f s: %s\n", plan.seed, violation.check,
              1e-6 * static_cast<double>(violation.at_us), violation.text.c_str());
  const Plan shortest = shrinks ? shrink(plan, violation.check) : plan;
  std::printf("\n%s\n", describe(shortest).c_str());
  if (!shrinks) return;
  tell_story(shortest, everything);
  const Outcome again = live(shortest);
  if (again.violation) std::printf("=> (%c) %s\n", again.violation->check, again.violation->text.c_str());
  std::fflush(stdout);
}

/// One seed a line; what follows it is for people.
std::vector<std::uint64_t> seeds_of(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw error_at(file, 0, "", "cannot be opened");
  std::vector<std::uint64_t> seeds;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line[0] != '#') seeds.push_back(std::stoull(line));
  return seeds;
}

int run(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const std::clock_t cpu_begin = std::clock();
  const Clock::time_point begin = Clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  constexpr std::uint64_t report_every = 10'000, remember_every = 500;  // seeds
  std::uint64_t lives = 0, failed = 0, trace = 0;
  double simulated_s = 0;
  std::int64_t compared = 0, messages = 0, certificates = 0, good = 0, scales = 0;
  std::size_t memory = 0;
  const std::vector<std::uint64_t> corpus =
      options.corpus.empty() ? std::vector<std::uint64_t>{} : seeds_of(options.corpus);
  const std::uint64_t count = options.corpus.empty() ? options.seeds : corpus.size();
  Progress before;
  if (options.resume.empty() || !read(options.resume, before)) before.seed = options.seed;
  trace = before.trace;
  const auto remember = [&] {
    if (!options.resume.empty())
      write_to(options.resume, {before.seed + lives, before.lives + lives, before.failed + failed, trace});
  };
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { asked_to_end = 1; });
  for (; options.minutes > 0 ? passed() < 60 * options.minutes : lives < count; ++lives) {
    if (asked_to_end) break;
    if (lives % remember_every == 0) remember();
    const std::uint64_t seed = options.corpus.empty() ? before.seed + lives : corpus[lives];
    const Plan plan = draw(seed);
    if (options.story) {
      std::printf("%s\n", describe(plan).c_str());
      tell_story(plan, options.everything);
    }
    watch(seed);
    const Outcome outcome = live(plan);
    std::optional<Violation> violation = outcome.violation;
    if (options.twice && !violation && live(plan).trace != outcome.trace)
      violation = Violation{'i', 0, "the same seed gives another trace"};
    trace = mixed(trace, outcome.trace);
    simulated_s += 1e-6 * static_cast<double>(outcome.simulated_us);
    compared += outcome.compared;
    messages += outcome.messages;
    certificates += outcome.certificates;
    good += outcome.judged_good;
    scales += outcome.scales;
    memory = std::max(memory, outcome.most_memory);
    if ((lives + 1) % report_every == 0) {
      std::printf("until seed %" PRIu64 ": %" PRIu64 " violations, trace %016" PRIx64 "\n", seed, failed,
                  trace);
      std::fflush(stdout);
    }
    if (!violation) continue;
    ++failed;
    const itimerval none{};
    setitimer(ITIMER_PROF, &none, nullptr);
    report(plan, *violation, !options.no_shrink, options.everything);
    std::fflush(stdout);
    if (options.until_failure) {
      ++lives;
      break;
    }
  }
  remember();
  const double cpu_s = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
  std::printf("seeds %" PRIu64 " to %" PRIu64 ": %" PRIu64 " lives, %" PRIu64
              " violations, %.0f s simulated in %.2f s of processor time (%.0f times real time), %" PRId64
              " messages, %" PRId64 " compared with an undisturbed run, %" PRId64
              " certificates by 113 bits, %" PRId64 " verdicts 'good', %" PRId64
              " scales, at most %zu kB a process, trace %016" PRIx64 "\n",
              before.seed, before.seed + lives - 1, lives, failed, simulated_s, cpu_s, simulated_s / cpu_s,
              messages, compared, certificates, good, scales, memory / 1024, trace);
  return failed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("egocal_simulation",
                   "Lives of all processes in virtual time, with faults drawn from a seed.", EGOCAL_VERSION);
  Options options;
  app.add_option("--seed", options.seed, "the first seed").show_default();
  app.add_option("--seeds", options.seeds, "how many").show_default();
  app.add_option("--minutes", options.minutes, "instead of --seeds: as many as fit");
  app.add_option("--corpus", options.corpus, "file with the seeds, one a line");
  app.add_option("--resume", options.resume,
                 "file with the progress of a long run, which continues from there");
  app.add_flag("--twice", options.twice, "live each life twice and compare the traces");
  app.add_flag("--story", options.story, "print what happens");
  app.add_flag("--everything", options.everything, "print each message as well");
  app.add_flag("--no-shrink", options.no_shrink, "do not look for the simplest plan that fails");
  app.add_flag("--until-failure", options.until_failure, "end with the first violation");
  if (const auto code = app.parse(argc, argv)) return *code;
  try {
    silence_services();
    return run(options);
  } catch (const Error& error) {
    std::printf("egocal_simulation: %s\n", error.what());
    return 1;
  }
}
