// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "program/program.hpp"
#include "solving/global.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string method = "dual";
  bool always = false;
  services::ProgramDescription description{
      "egocal-global",
      bus::Role::global,
      EGOCAL_VERSION,
      "Solves sensor pairs to global optimality: when the fast process asks for it, or while none is alive.",
      {},
      {}};
  description.options = {{"--method", "global solver", &method, {"dual", "sdp"}}};
  description.flags = {{"--always", "answer every problem", &always}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    return std::make_shared<services::GlobalSolver>(loop, heartbeat, rig, *method_from_name(method), always);
  });
}
