// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>

#include "egocal/bus/answer_check.hpp"
#include "egocal/bus/scale.hpp"
#include "egocal/monitor/model.hpp"

namespace egocal::monitor {

/// Delivers messages to the model, live or from a log: decodes them, checks them by the rules of all
/// processes, and verifies each answer against its problem.
class Delivery {
 public:
  explicit Delivery(Model& model) : model_(model) {}

  /// One encoded message, whichever of egocal's it is.
  void deliver(const std::string& channel, std::span<const std::byte> bytes, Now now);

 private:
  void problem(const problem_t& message, Now now);
  void calibration(calibration_t& message, Now now);
  void verdict(const verdict_t& message, Now now);
  void scale_problem(const scale_problem_t& message, Now now);
  void scale(const scale_t& message, Now now);

  Model& model_;
  bus::AnswerCheck answers_;
  bus::ScaleCheck scales_;
};

}  // namespace egocal::monitor
