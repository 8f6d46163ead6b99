// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "answers/answers.hpp"
#include "egocal/bus/answer_age.hpp"
#include "egocal/bus/rig.hpp"
#include "egocal/bus/stream_watch.hpp"

namespace egocal::tools {

/// Study: tests/tools/test_bus_news.cpp.
struct BusNewsOptions {
  bus::AnswerAgeOptions answer_age;
  /// Pairing lives, and has found no new motion for longer [s]: as the monitor, ten steps of the slowest
  /// sensors.
  double standing = 5;
  /// A pair whose sensors both send has its first motion within this [s]: the stride is chosen from some
  /// dozens of poses, and slow sensors send one a second.
  double first_motion = 60;
  /// Pairing sends its problems every second. Where none has come for longer, it is silent itself [s].
  double pairing_silent = 2;
  /// A new motion may overtake the command that pauses its pair [s].
  double settle = 1;
  /// An error is over where none has been reported for so long [s]: a process that was restarted meets the
  /// same one within its first second.
  double over_after = 2;
  /// What comes again and again is reported this often [s], as a process that ends again and again is.
  double repeat_report = 60;
  /// Both sensors of a pair may be silent: a log has gaps, and an end. Live they never should.
  bool live = true;
};

/// Reports for a user without a monitor: errors of pairing and the diagnosis, pairs that no solver answers,
/// and pairs that find no new motion. Each is reported once when it begins and once when it is over. Times
/// are those of the loop's clock [us].
class BusNews {
 public:
  BusNews(const bus::Rig& rig, const BusNewsOptions& options);

  void hear(const status_t& status, std::int64_t now_us);
  void hear(const problem_t& problem, std::int64_t now_us);
  void hear(const command_t& command, std::int64_t now_us);
  /// Takes a message of a sensor.
  void hear(const std::string& channel, bus::Bytes bytes, std::int64_t now_us);

  /// The lines since the last call, each with its end.
  std::string lines(const Answers& answers, std::int64_t now_us);

  /// Why there is no answer, where there is none: "pairing found no motion: it rejected 540 x frozen (what to
  /// do)"; empty: there were motions.
  std::string why_nothing() const;

 private:
  static constexpr std::size_t most_errors = 100, most_reasons = 100;  // limits on memory
  struct Pair {
    bus::AnswerAge age;
    bool unanswered_reported = false;
    std::optional<std::pair<std::int64_t, std::int64_t>> newest;  ///< session and number of a problem,
    std::int64_t problem_us = 0;                                  ///< when one came
    /// When a new problem came, or could come first: pairing was paused or silent until then.
    std::int64_t motion_us = 0;
    std::optional<std::int64_t> paused_us;
    bool standing_reported = false;
    std::optional<std::int64_t> standing_reported_us;
  };

  /// A counter of pairing.
  struct Rejected {
    std::int64_t count = 0, growth = 0, grown_us = 0;
  };
  /// What a process says that it could not do; an empty text: nothing.
  struct Complaint {
    std::string process, text;
    bool operator==(const Complaint&) const = default;
    std::string line() const { return process + ": " + text; }
  };
  /// What the processes of a role complain about, and what was reported of it last.
  struct Error {
    Complaint now, reported;
    std::int64_t since_us = 0;
    /// Starts of processes (status_t::run): the last one that complained, and the one heard last. A process
    /// that was restarted without its state file has no error with it either.
    std::int64_t complained = 0, heard = 0;
  };

  void hear_error(const status_t& status, std::int64_t now_us);
  std::string errors(std::int64_t now_us);
  void count_rejections(const status_t& status, std::int64_t now_us);
  std::string mostly_rejected(std::int64_t now_us) const;
  std::string why_standing(const Pair& of, const PairName& pair, std::int64_t now_us) const;
  std::string unanswered(Pair& of, const PairName& pair, const Answers& answers, std::int64_t now_us) const;
  std::string standing(Pair& of, const PairName& pair, std::int64_t now_us) const;

  const bus::Rig& rig_;
  BusNewsOptions options_;
  bus::StreamWatch streams_;
  std::map<PairName, Pair> pairs_;
  std::string pairing_;  ///< name of the process that sends the problems; empty: not heard yet
  bool pairing_paused_ = false;
  std::map<std::string, Rejected> rejected_;         ///< by reason
  std::map<std::string, Error> errors_;              ///< by role
  std::map<std::string, std::int64_t> reported_us_;  ///< of each line about an error
  std::string pending_;                              ///< lines that were not asked for yet
};

}  // namespace egocal::tools
