// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program/program.hpp"
#include "solving/fast.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string method = "sqp";
  services::ProgramDescription description{
      "egocal-fast",
      bus::Role::fast,
      EGOCAL_VERSION,
      "Solves each sensor pair from its last answer and verifies it at every step.",
      {},
      {}};
  description.options = {{"--method", "local solver", &method, {"sqp", "slsqp"}}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    return std::make_shared<services::FastSolver>(loop, heartbeat, rig, *method_from_name(method));
  });
}
