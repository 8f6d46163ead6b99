// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A verdict of the sender is no proof: a listener receives the problems as well, and verifies each answer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "egocal/bus/convert.hpp"
#include "egocal/bus/recent_pairs.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/calibration_t.hpp"
#include "egocal/online/algorithm1.hpp"
#include "egocal/problem_t.hpp"

namespace egocal::bus {

enum class Standing {
  verified,    ///< its problem is known: the certificate is this listener's own
  unverified,  ///< its problem has not been received (yet): the certificate is the sender's word
  refused,     ///< not an answer: out of range, contradicts itself, or its problem denies the certificate
};

/// An answer as a listener may use it.
struct CheckedAnswer {
  Standing standing = Standing::refused;
  /// Its certificate is this listener's own where it could be computed, whatever the sender claimed. Not
  /// certified unless verified.
  Answer answer;
  std::optional<Problem> problem;  ///< that it answers, without its blocks; of a verified one only
  std::string reason;              ///< of a refusal, a short constant text that also names its counter
};

/// The newest problems of all pairs, and the checks of the answers to them: about 2 us each, five times that
/// with a prior. Memory is bounded whatever arrives. Not thread-safe.
class AnswerCheck {
 public:
  /// Returns the reason of a refusal; empty: the message was accepted.
  std::string take(const problem_t& message);
  CheckedAnswer check(const calibration_t& message) const;
  /// Returns the reason why a verdict is refused: it calls an answer good although its problem shows that the
  /// answer is not the optimum. Empty: it is not refused, or its problem is not known here. Whether the
  /// motions agree cannot be checked without the poses: the sender is believed.
  std::string refusal(const verdict_t& message, const ReceivedVerdict& received) const;

  static constexpr std::size_t max_pairs = bus::max_pairs;
  static constexpr std::size_t problems_per_pair = 16;  ///< answers come within a few problems

 private:
  struct Known {
    std::int64_t session = 0, seq = 0, utime = 0;
    Matrix8d Q;       ///< certified_cost() of the problem
    Problem problem;  ///< without its blocks
  };
  struct Pair {
    std::vector<Known> problems;
    std::size_t next = 0;  ///< where the next one goes
  };
  template <class Message>
  const Known* find(const Message& message) const;

  RecentPairs<Pair> pairs_;
};

/// Copies the certificate of a checked answer into its message, so that what is shown of the message
/// is what was verified.
void set_certificate(const CheckedAnswer& checked, calibration_t& message);

/// What is needed to choose between answers: an answer that could not be verified never outranks one that
/// was, whatever problem it claims to belong to.
struct StandingRank {
  Standing standing = Standing::refused;
  AnswerRank rank;
};
bool outranks(const StandingRank& x, const StandingRank& y);
StandingRank rank_of(const CheckedAnswer& checked, const calibration_t& message);

}  // namespace egocal::bus
