// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <string>

#include "diagnosis/diagnosing.hpp"
#include "program/program.hpp"

using namespace egocal;

int main(int argc, char** argv) {
  std::string state_file;
  services::ProgramDescription description{"egocal-diagnosis",
                                           bus::Role::diagnosis,
                                           EGOCAL_VERSION,
                                           "Judges each pair's answer by the sensors' poses: can it be "
                                           "used, and if not, why, and what to drive next.",
                                           {},
                                           {}};
  description.options = {
      {"--state", "file from which it continues after it was ended or killed", &state_file, {}}};
  return services::run_program(argc, argv, description, [&](auto& loop, auto& heartbeat, const auto& rig) {
    std::unique_ptr<services::SavedMemory> saved;
    if (!state_file.empty()) saved = std::make_unique<services::SavedMemory>(state_file, rig);
    services::SavedMemory* const file = saved.get();
    auto diagnosing = std::make_shared<services::Diagnosing>(loop, heartbeat, rig, std::move(saved));
    if (file && !file->refused().empty())
      std::fprintf(stderr, "egocal-diagnosis: %s\n", file->refused().c_str());
    return diagnosing;
  });
}
