// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/pairing.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  const services::ProgramDescription description{
      "egocal-pairing",
      "pairing",
      EGOCAL_VERSION,
      "Takes in the sensors' odometry, forms synchronised motion pairs and sends what the solvers minimise.",
      {},
      {}};
  return services::run_program(argc, argv, description, [](auto& loop, auto& heartbeat, const auto& rig) {
    return std::make_shared<services::Pairing>(loop, heartbeat, rig);
  });
}
