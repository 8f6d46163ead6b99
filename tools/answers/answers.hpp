// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "egocal/bus/answer_check.hpp"

namespace egocal::tools {

using PairName = std::pair<std::string, std::string>;  ///< sensors a and b

/// Of the answers to each pair's problems the one that counts, verified against the problem itself: a
/// sender's verdict is not taken for a proof.
class Answers {
 public:
  struct Best {
    calibration_t message;
    bus::CheckedAnswer checked;
    bool certified() const {
      return checked.standing == bus::Standing::verified &&
             checked.answer.certificate.optimality == Optimality::certified;
    }
  };

  void hear(const problem_t& message);
  void hear(const calibration_t& message);

  /// Null: none.
  const Best* best(const PairName& pair) const;
  const std::map<PairName, Best>& all() const { return best_; }
  /// Answers that were refused, by reason.
  const std::map<std::string, std::int64_t>& refused() const { return refused_; }

 private:
  void consider(const PairName& pair, Best candidate);

  bus::AnswerCheck check_;
  std::map<PairName, Best> best_;
  std::map<PairName, calibration_t> early_;  ///< heard before its problem
  std::map<std::string, std::int64_t> refused_;
};

/// "lidar,camera", as --pair takes it.
std::string text(const PairName& pair);

/// The answers that a log of a session holds, each pair's of the session that was running when the log ended.
Answers recorded_answers(const std::string& log);

}  // namespace egocal::tools
