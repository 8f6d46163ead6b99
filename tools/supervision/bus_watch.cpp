// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/bus_watch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <new>
#include <utility>
#include <vector>

#include "answers/answers.hpp"
#include "egocal/bus/channels.hpp"
#include "egocal/bus/convert.hpp"
#include "egocal/bus/loop.hpp"
#include "egocal/error.hpp"

namespace egocal::tools {

std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time) {
  bus::Loop loop(url, {.handle_signals = false, .require_network = false});
  std::optional<std::string> found;
  loop.subscribe<status_t>(bus::status_channel, [&](const status_t& status, const bus::Arrival&) {
    if (status.role == "pairing" && status.state != "ended")
      found = fmt::format("{} (pid {} on {})", bus::printable(status.name, 40), status.pid,
                          bus::printable(status.host, 60));
  });
  const auto end = std::chrono::steady_clock::now() + time;
  for (auto now = std::chrono::steady_clock::now(); !found && now < end;
       now = std::chrono::steady_clock::now())
    loop.run_once(end - now);
  return found;
}

namespace {

/// A verdict that does not know the end of the drive states that first.
std::string judgement_of(const PairName& pair, const Answers& answers) {
  const Diagnosis* const diagnosis = answers.diagnosis(pair);
  if (!diagnosis) return "not judged";
  const double rest = answers.seconds_not_judged(pair).value_or(0);
  const bool to_the_end = answers.judged_to_the_end(pair) || rest == 0;
  return (to_the_end ? "" : fmt::format("the last {:.1f} s are not judged; before: ", rest)) +
         verdict_line(*diagnosis);
}

/// Of a pair that has an answer.
std::string line_of(const PairName& pair, const Answers& answers) {
  const Answers::Best& best = *answers.best(pair);
  const bus::CheckedScale* const scale = answers.scale(pair);
  const Pose T = to_pose(best.checked.answer.T_a_b);
  const Eigen::Quaterniond& q = T.rotation;
  std::string text = fmt::format(
      "{} -> {}: {}\n  {}, {} motion pairs; "
      "translation {:.4f} {:.4f} {:.4f} m, rotation w x y z {:.5f} {:.5f} {:.5f} {:.5f}\n",
      pair.first, pair.second, judgement_of(pair, answers),
      answers.certified(pair) ? "optimal (proven)" : "not proven to be optimal", best.message.pairs,
      T.translation.x(), T.translation.y(), T.translation.z(), q.w(), q.x(), q.y(), q.z());
  if (scale)
    text += fmt::format("  scale of {} {:.6g} +- {:.2g}, {}\n", scale->sensor, scale->solution.scale,
                        scale->solution.stddev,
                        scale->verified && scale->solution.certified ? "optimal (proven)" : "not proven");
  if (answers.lacks_scale(pair))
    text += "  the scale could not be verified: this answer holds at a scale that is not known\n";
  return text;
}

/// What the motions cannot rule out, once for all pairs of which it holds.
std::string possible_of_all(const bus::Rig& rig, const Answers& answers) {
  std::map<std::string, std::vector<std::string>> pairs_of;
  for (const bus::PairConfig& config : rig.pairs)
    if (const Diagnosis* const diagnosis = answers.diagnosis({config.a, config.b}))
      for (const std::string& line : possible_lines(*diagnosis))
        pairs_of[line].push_back(config.a + " -> " + config.b);
  std::string text;
  for (const auto& [line, pairs] : pairs_of)
    text += fmt::format("possible, {}: {}\n",
                        pairs.size() == 1 ? pairs[0] : fmt::format("{} pairs", pairs.size()), line);
  return text;
}

/// What the parent reads: a character each for answered and unusable, then the text.
std::string report(const bus::Rig& rig, const Answers& answers) {
  Outcome outcome;
  for (const bus::PairConfig& config : rig.pairs) {
    const PairName pair{config.a, config.b};
    if (!answers.best(pair)) {
      outcome.text += fmt::format("{} -> {}: no answer\n", pair.first, pair.second);
      continue;
    }
    const Diagnosis* diagnosis = answers.diagnosis(pair);
    outcome.answered = true;
    outcome.unusable = outcome.unusable || (diagnosis && unusable(*diagnosis));
    outcome.text += line_of(pair, answers);
  }
  outcome.text += possible_of_all(rig, answers);
  return std::string(outcome.answered ? "1" : "0") + (outcome.unusable ? "1" : "0") + outcome.text;
}

void write_all(int out, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(out, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) return;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

int not_judged(const bus::Rig& rig, const Answers& answers) {
  return static_cast<int>(
      std::count_if(rig.pairs.begin(), rig.pairs.end(), [&](const bus::PairConfig& config) {
        const PairName pair{config.a, config.b};
        return answers.best(pair) && !answers.judged_to_the_end(pair);
      }));
}

[[noreturn]] void listen(const bus::Rig& rig, const std::string& url, int out,
                         std::atomic<int>& not_judged_count) {
  try {
    bus::Loop loop(url, {.require_network = false});
    Answers answers;
    answers.expect_scales(rig);
    const auto hear = [&](const auto& message, const bus::Arrival&) { answers.hear(message); };
    for (const bus::PairConfig& pair : rig.pairs) {
      loop.subscribe<problem_t>(bus::problem_channel(pair.a, pair.b), hear);
      loop.subscribe<calibration_t>(bus::calibration_channel(pair.a, pair.b), hear);
      loop.subscribe<verdict_t>(bus::verdict_channel(pair.a, pair.b), hear);
      loop.subscribe<scale_problem_t>(bus::scale_problem_channel(pair.a, pair.b), hear);
      loop.subscribe<scale_t>(bus::scale_channel(pair.a, pair.b), hear);
    }
    loop.every(std::chrono::milliseconds(100), [&] { not_judged_count = not_judged(rig, answers); });
    loop.run();
    write_all(out, report(rig, answers));
  } catch (const std::exception&) {
    // nothing was received, then
  }
  _exit(0);
}

}  // namespace

AnswerListener::AnswerListener(const bus::Rig& rig, const std::string& url) {
  void* const shared =
      mmap(nullptr, sizeof *not_judged_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw Error(std::string("mmap: ") + std::strerror(errno));
  not_judged_ = new (shared) std::atomic<int>(0);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw Error(std::string("pipe: ") + std::strerror(errno));
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(0);
    setpgid(0, 0);  // a Ctrl-C is not for it
    close(ends[0]);
    listen(rig, url, ends[1], *not_judged_);
  }
  close(ends[1]);
  pipe_ = ends[0];
  if (pid_ > 0) return;
  close(pipe_);
  throw Error(std::string("fork: ") + std::strerror(errno));
}

AnswerListener::~AnswerListener() {
  end();
  close(pipe_);
  munmap(not_judged_, sizeof *not_judged_);
}

void AnswerListener::end() {
  if (pid_ < 0) return;
  kill(pid_, SIGTERM);
  // what it still writes must not block it
  const pid_t pid = std::exchange(pid_, -1);
  char rest[4096];
  while (read(pipe_, rest, sizeof rest) > 0) {
  }
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

Outcome AnswerListener::outcome() {
  kill(pid_, SIGTERM);
  std::string text;
  char part[4096];
  for (ssize_t n = 1; n > 0 || (n < 0 && errno == EINTR);) {
    n = read(pipe_, part, sizeof part);
    if (n > 0) text.append(part, static_cast<std::size_t>(n));
  }
  end();
  if (text.size() < 2) return {};
  return {text[0] == '1', text[1] == '1', text.substr(2)};
}

}  // namespace egocal::tools
