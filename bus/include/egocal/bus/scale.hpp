// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Scale problems and scales on the wire, checked as other messages are.
#pragma once

#include <optional>
#include <string>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/recent_pairs.hpp"
#include "egocal/scale/scale_drive.hpp"
#include "egocal/scale_problem_t.hpp"
#include "egocal/scale_t.hpp"

namespace egocal::bus {

/// Side, mode, range, weights and blocks; the rest is the sender's.
scale_problem_t to_message(const ScaleProblem& problem);
/// Checks the whole message: a value means that every field may be used as it stands.
Checked<ScaleProblem> to_scale_problem(const scale_problem_t& message);

/// The answer to a scale problem; who solved it and how long it took is the sender's to fill in.
scale_t to_message(const ScaleSolution& solution, const scale_problem_t& problem);
/// Checks the whole message, and that it does not contradict itself. The extrinsic is not sent: it is that of
/// the pair's calibration_t.
Checked<ScaleSolution> to_scale(const scale_t& message);

/// The scale of a pair as a listener may show it.
struct CheckedScale {
  std::string sensor;  ///< whose scale it is
  ScaleSolution solution;
  std::int64_t session = 0, seq = 0;
  bool verified = false;  ///< this listener solved the problem itself and found the same
};

/// The newest scale problems of all pairs, and the checks of the answers to them: a sender's verdict is no
/// proof, and solving costs a fraction of a millisecond. Memory is bounded whatever arrives. Not thread-safe.
class ScaleCheck {
 public:
  /// Returns the reason of a refusal; empty: the message was accepted.
  std::string take(const scale_problem_t& message);
  std::string take(const scale_t& message);
  /// The newest checked scale of this pair and session; null: there is none. Certified only if verified.
  const CheckedScale* find(const std::string& a, const std::string& b, std::int64_t session) const;
  /// The scale with which the problem_t of the pair is made; empty: there is none yet.
  std::optional<double> in_force(const std::string& a, const std::string& b, std::int64_t session) const;
  /// Solves the newest scale problem of this pair; null: there is none of this session.
  const ScaleSolution* solution(const std::string& a, const std::string& b, std::int64_t session);

 private:
  struct Pair {
    std::int64_t session = 0, seq = -1;
    double in_force = 0;
    ScaleProblem problem;
    std::optional<ScaleSolution> own;  ///< of this problem, once an answer was to be checked
    std::optional<scale_t> early;      ///< an answer that came before its problem
    std::optional<CheckedScale> scale;
  };
  RecentPairs<Pair> pairs_;
};

}  // namespace egocal::bus
