// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/diagnosing.hpp"
#include "program/program.hpp"
#include "state/state_option.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string state_file;
  services::ProgramDescription description{"egocal-diagnosis",
                                           bus::Role::diagnosis,
                                           EGOCAL_VERSION,
                                           "Judges each pair's answer by the sensors' poses: can it be "
                                           "used, and if not, why, and what to drive next.",
                                           {services::state_option(state_file)},
                                           {}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    return services::with_state<services::Diagnosing, services::SavedMemory>(description.name, state_file,
                                                                             loop, heartbeat, rig);
  });
}
