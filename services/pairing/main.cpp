// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pairing.hpp"
#include "program/program.hpp"
#include "state/state_option.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string state_file;
  services::ProgramDescription description{
      "egocal-pairing",
      bus::Role::pairing,
      EGOCAL_VERSION,
      "Takes in the sensors' odometry, forms synchronised motion pairs and sends what the solvers minimise.",
      {services::state_option(state_file)},
      {}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    return services::with_state<services::Pairing, services::SavedState>(description.name, state_file, loop,
                                                                         heartbeat, rig);
  });
}
