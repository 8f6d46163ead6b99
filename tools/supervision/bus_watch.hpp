// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>

#include "egocal/bus/rig.hpp"

namespace egocal::tools {

/// A pairing process that is heard on the bus within this time, for people: "egocal-pairing (pid 7 on car)".
std::optional<std::string> pairing_heard(const std::string& url, std::chrono::milliseconds time);

/// Whether any solver answered while this object lived: a process of its own that listens, so that the
/// supervisor has no threads. Ends with us.
class AnswerWitness {
 public:
  AnswerWitness(const bus::Rig& rig, const std::string& url);
  ~AnswerWitness();
  AnswerWitness(const AnswerWitness&) = delete;
  AnswerWitness& operator=(const AnswerWitness&) = delete;

  bool heard() const;

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
};

}  // namespace egocal::tools
