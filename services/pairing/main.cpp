// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "pairing/pairing.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string state_file;
  services::ProgramDescription description{
      "egocal-pairing",
      bus::Role::pairing,
      EGOCAL_VERSION,
      "Takes in the sensors' odometry, forms synchronised motion pairs and sends what the solvers minimise.",
      {},
      {}};
  description.options = {
      {"--state", "file from which it continues after it was ended or killed", &state_file, {}}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    std::unique_ptr<services::SavedState> saved;
    if (!state_file.empty()) saved = std::make_unique<services::SavedState>(state_file, rig);
    services::SavedState* const file = saved.get();
    auto pairing = std::make_shared<services::Pairing>(loop, heartbeat, rig, std::move(saved));
    if (file && !file->refused().empty())
      std::fprintf(stderr, "egocal-pairing: %s\n", file->refused().c_str());
    return pairing;
  });
}
