// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/bus_watch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

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

[[noreturn]] void listen(const bus::Rig& rig, const std::string& url, int out) {
  try {
    bus::Loop loop(url, {.require_network = false});
    for (const bus::PairConfig& pair : rig.pairs)
      loop.subscribe<calibration_t>(bus::calibration_channel(pair.a, pair.b),
                                    [&](const calibration_t& message, const bus::Arrival&) {
                                      if (bus::to_answer(message) && write(out, "x", 1) == 1) loop.stop();
                                    });
    loop.run();
  } catch (const std::exception&) {
    // not heard, then
  }
  _exit(0);
}

}  // namespace

AnswerWitness::AnswerWitness(const bus::Rig& rig, const std::string& url) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) throw Error(std::string("pipe: ") + std::strerror(errno));
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(0);
    setpgid(0, 0);  // a Ctrl-C is not for it
    listen(rig, url, ends[1]);
  }
  close(ends[1]);
  pipe_ = ends[0];
  if (pid_ > 0) return;
  close(pipe_);
  throw Error(std::string("fork: ") + std::strerror(errno));
}

AnswerWitness::~AnswerWitness() {
  kill(pid_, SIGTERM);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  close(pipe_);
}

bool AnswerWitness::heard() const {
  pollfd pipe{pipe_, POLLIN, 0};
  return poll(&pipe, 1, 0) > 0 && (pipe.revents & POLLIN) != 0;
}

}  // namespace egocal::tools
