// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "egocal/monitor/model.hpp"
#include "scene.hpp"

namespace egocal::monitor::test {

/// A drive of one pair, ten motions a second, whose messages can be changed before they are sent.
struct PairDrive {
  Model model;
  std::int64_t step = 0;
  bool global = false, fast = true;
  std::function<void(problem_t&)> change_problem = [](problem_t&) {};
  std::function<void(calibration_t&)> change_answer = [](calibration_t&) {};

  Now now() const { return {1'000'000 + step * 100'000, begin_utime + step * 100'000}; }
  void run(int steps) {
    for (int i = 0; i < steps; ++i, ++step) {
      problem_t problem = problem_at("lidar", "camera", step, 10);
      change_problem(problem);
      model.on_problem(problem, now());
      for (const bool which : {true, false}) {
        if (which ? !global : !fast) continue;
        calibration_t answer = calibration_at(problem, which);
        if (which || step >= 8) answer.fallback = 0;
        change_answer(answer);
        model.on_calibration(answer, now());
      }
      model.tick(now());
    }
  }
  void heartbeat(const status_t& status) { model.on_status(status, now()); }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const Event& event : model.events()) all.push_back(event.subject + ": " + event.text);
    return all;
  }
  const PairState& pair() const { return model.pairs().front(); }
  std::size_t seen = 0;
  /// The events since the last call.
  std::vector<std::string> fresh() {
    std::vector<std::string> all = texts();
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(seen));
    seen += all.size();
    return all;
  }
};

}  // namespace egocal::monitor::test
