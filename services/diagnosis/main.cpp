// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/diagnosing.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  const services::ProgramDescription description{"egocal-diagnosis",
                                                 bus::Role::diagnosis,
                                                 EGOCAL_VERSION,
                                                 "Judges each pair's answer by the sensors' poses: can it be "
                                                 "used, and if not, why, and what to drive next.",
                                                 {},
                                                 {}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    return std::make_shared<services::Diagnosing>(loop, heartbeat, rig);
  });
}
