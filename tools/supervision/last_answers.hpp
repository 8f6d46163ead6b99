// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// How long the answers that are missing after a log's end are waited for. No clock and no processes here.
#pragma once

#include <chrono>
#include <optional>

namespace egocal::tools {

/// A core that others take is not an end, and a process that turns in circles is none that answers.
struct LastAnswersOptions {
  /// In which no process has work and no further answer comes: a diagnosis takes seconds on a small computer.
  std::chrono::milliseconds stall{5000};
  /// Without a further answer, even where a process has work. New motions come no later than this after the
  /// log's end.
  std::chrono::milliseconds longest_stall{60'000};
};

class LastAnswers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit LastAnswers(const LastAnswersOptions& options) : options_(options) {}

  bool begun() const { return missing_.has_value(); }
  /// Whether to wait on. missing: answers; more than before are news as well, as new motions were found.
  /// has_work: any process.
  bool wait_on(int missing, bool has_work, Time now);

 private:
  LastAnswersOptions options_;
  std::optional<int> missing_;
  Time begun_at_{}, news_at_{}, asked_at_{};
  Time::duration idle_{};  ///< since the last news
};

}  // namespace egocal::tools
