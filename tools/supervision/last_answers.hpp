// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How long the answers that are missing after a log's end are waited for. No clock and no processes here.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace egocal::tools {

/// What the processes that answer do at this moment, all of them together.
struct Work {
  bool computes = false;                  ///< one has a core, or waits for one
  bool held = false;                      ///< one has work, and is stopped or waits for its disk
  std::chrono::nanoseconds processor{0};  ///< that they have had since they were started
};

/// A core that others take is not an end, and a process that turns in circles is none that answers.
struct LastAnswersOptions {
  /// Waiting ends after this long without work of any process and without a further answer: messages and
  /// timers between processes take a second.
  std::chrono::milliseconds stall{5000};
  /// Waiting also ends after this long without a further answer: of processor time while a process computes,
  /// of any time while one is held. A diagnosis takes a second of a core, which is a minute where children
  /// get a sixtieth of it.
  std::chrono::milliseconds longest_stall{60'000};
  /// Questions are a tenth of a second apart, and at most this much counts between two of them. A longer
  /// pause means that the supervisor itself had no core, so the processes that answer had none either.
  std::chrono::milliseconds longest_step{300};
  /// Time until the first report of what is awaited; each further interval is twice as long.
  std::chrono::milliseconds report{10'000};
};

/// What is said while they are waited for.
struct Waited {
  std::chrono::milliseconds time{0};       ///< since the first question
  std::chrono::milliseconds processor{0};  ///< that the processes have had in it
};

/// Why it takes so long: processes that hardly get a core are slow, not stuck. missing: answers.
std::string in_words(int missing, const Waited& waited);

class LastAnswers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit LastAnswers(const LastAnswersOptions& options)
      : options_(options), report_after_(options.report) {}

  bool begun() const { return missing_.has_value(); }
  /// Whether to wait on. missing: answers; more than before are news as well, as new motions were found.
  bool wait_on(int missing, const Work& work, Time now);
  /// How long the answers have been waited for, where it is time to say so.
  std::optional<Waited> to_report();

 private:
  LastAnswersOptions options_;
  std::optional<int> missing_;
  Time begun_at_{}, asked_at_{};
  std::chrono::nanoseconds processor_{0};         ///< at the last question
  std::chrono::nanoseconds waited_processor_{0};  ///< since the first one
  Time::duration idle_{}, busy_{};                ///< since the last news
  Time::duration report_after_;
};

}  // namespace egocal::tools
