// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "egocal/bus/answer_check.hpp"
#include "egocal/bus/departure.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/bus/verdict.hpp"
#include "egocal/uncertainty/directions.hpp"

namespace egocal::tools {

/// Exit code: an answer was given that should not be used.
inline constexpr int not_to_be_used = 3;

using PairName = std::pair<std::string, std::string>;  ///< sensors a and b

/// For each pair, the answer to its problems that counts. It is verified against the problem itself: a
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

  /// The pairs of this rig whose scale is to be found: their answers hold only at a scale that is known.
  void expect_scales(const bus::Rig& rig);

  void hear(const problem_t& message);
  void hear(const calibration_t& message);
  void hear(const verdict_t& message);
  void hear(const scale_problem_t& message);
  void hear(const scale_t& message);

  /// The answer that counts; null: there is none.
  const Best* best(const PairName& pair) const;
  /// The newest verdict about the session of the answer that counts; null: none.
  const Diagnosis* diagnosis(const PairName& pair) const;
  /// What the answer that counts knows of each direction, by the newest verdict about its session where there
  /// is one. There must be an answer.
  Observability observability(const PairName& pair) const;
  /// How far the answer that counts is from the one that diagnosis() calls good; empty: the verdict holds for
  /// the answer, or there is no verdict.
  std::optional<bus::Departure> departure(const PairName& pair) const;
  /// Whether diagnosis() is about the newest problem that was heard, by poses up to its end; where none was
  /// heard, whether there is a verdict.
  bool judged_to_the_end(const PairName& pair) const;
  /// How much of the drive came after what diagnosis() is about [s]; nothing: there is no verdict.
  std::optional<double> seconds_not_judged(const PairName& pair) const;
  /// Whether the answer that counts is one to the newest problem that was heard; true where none was heard.
  bool answered_to_the_end(const PairName& pair) const;
  /// How much of the drive came after what the answer that counts knows [s]; 0 where it knows all of it.
  double seconds_not_answered(const PairName& pair) const;
  /// End of the newest motion that was heard of [us, time of a], and what is added to the time of b [s];
  /// nothing: none was.
  std::optional<std::pair<std::int64_t, double>> end_of_motions(const PairName& pair) const;
  /// What pairing had made of the drive when a motion was its newest.
  struct Passed {
    std::int64_t utime = 0;              ///< end of that motion [us, time of a]
    std::int64_t seq = 0, rejected = 0;  ///< motions since the session's begin, and what gave none
    std::int64_t stride = 1;
    double time_offset = 0;  ///< what is added to the time of b [s]
  };
  /// The course of the newest problem's session, from its begin on, thinned to some thousands of entries;
  /// empty: there is no such problem.
  const std::vector<Passed>& passed(const PairName& pair) const;
  /// The scale that was found together with the answer that counts; null: none was looked for, or received.
  const bus::CheckedScale* scale(const PairName& pair) const;
  /// Whether the scale of one of the pair's sensors is to be found, and no verified scale is known of the
  /// session of the answer that counts.
  bool lacks_scale(const PairName& pair) const;
  /// Whether there is an answer that is verified and optimal, and the scale that it holds at is known.
  bool certified(const PairName& pair) const;
  const std::map<PairName, Best>& all() const { return best_; }
  /// Answers that were refused, by reason.
  const std::map<std::string, std::int64_t>& refused() const { return refused_; }

 private:
  struct Judgement {
    std::int64_t session = 0, seq = 0, utime = 0;
    Diagnosis diagnosis;
    bus::Judged judged;
  };
  /// The newest problem of a pair. Numbers may go back: another pairing process took over for a while, or the
  /// disk had no room for the newest session. Problems that arrive again and again are believed then.
  struct Newest {
    std::int64_t session = 0, seq = 0, utime = 0;
    double time_offset = 0;
    int older_in_a_row = 0;
    std::vector<Passed> passed;
    std::int64_t passed_step_us = 1'000'000;  ///< between two of them
  };
  const Judgement* judgement(const PairName& pair) const;
  void note(const problem_t& message);
  static void note_passed(const problem_t& message, Newest& newest);
  bool is_ahead(const PairName& pair, const calibration_t& message) const;
  void consider(const PairName& pair, Best candidate);

  bus::AnswerCheck check_;
  std::map<PairName, Newest> newest_;
  std::map<PairName, Best> best_;
  std::map<PairName, calibration_t> early_;  ///< received before its problem
  std::map<PairName, Judgement> judgements_;
  bus::ScaleCheck scales_;
  std::set<PairName> unscaled_;  ///< expected, or a scale problem was received
  std::map<std::string, std::int64_t> refused_;
};

/// Whether an answer should not be used: the motions contradict it, or it misses the goal that the rig
/// states.
bool unusable(const Diagnosis& diagnosis);
/// "contradictory: the reason. Cure: ...": verdict, reason, what cures it and how far the goal is, one line.
std::string verdict_line(const Diagnosis& diagnosis);
/// "What else explains the motions. Cure: ...": what they cannot rule out, besides what the verdict's line
/// names.
std::vector<std::string> possible_lines(const Diagnosis& diagnosis);

/// "lidar,camera", as --pair takes it.
std::string text(const PairName& pair);

/// The answers that a log of a session holds, each pair's of the session that was running when the log ended.
Answers recorded_answers(const std::string& log);

}  // namespace egocal::tools
