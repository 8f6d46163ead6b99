// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/saved_memory.hpp"

#include <exception>
#include <utility>

#include "egocal/error.hpp"
#include "state/state_fields.hpp"
#include "state/state_identity.hpp"

namespace egocal::services {

namespace {

/// Version of the fields below and of those that they hold. Raise it whenever either changes.
constexpr int memory_layout = 1000 * 2 + state_layout;

}  // namespace

void fields(auto& archive, Is<DriveSampleState> auto& value) {
  auto& [a, b, time_offset_us, origin_us, level, begun_anew] = value;
  archive(a, b, time_offset_us, origin_us, level, begun_anew);
}

void fields(auto& archive, Is<OffsetSince> auto& value) {
  auto& [time_us, offset_us] = value;
  archive(time_us, offset_us);
}

void fields(auto& archive, Is<PairMemory> auto& value) {
  auto& [sample, session, matched, matched_before, matched_between, missed_us, restarted_session, offsets] =
      value;
  archive(sample, session, matched, matched_before, matched_between, missed_us, restarted_session, offsets);
}

void fields(auto& archive, Is<Memory> auto& value) {
  auto& [streams, pairs] = value;
  archive(streams, pairs);
}

SavedMemory::SavedMemory(const std::string& file, const bus::Rig& rig, StateFile::Clock clock,
                         const StateOptions& options)
    : file_(open_state_medium(file, options), state_identity("egocal-diagnosis", memory_layout, rig),
            std::move(clock), options) {}

bool SavedMemory::restore(const std::function<void(Memory)>& take) {
  const std::optional<StateFile::Content> content = file_.read();
  if (!content) return false;
  try {
    Memory memory;
    Reader reader(content->snapshot);
    reader(memory);
    if (!reader.done()) throw Error("is damaged");
    take(std::move(memory));
    return true;
  } catch (const std::exception& error) {
    file_.refuse(error.what());
    return false;
  }
}

void SavedMemory::save(const Memory& memory) {
  Writer writer;
  writer(memory);
  file_.snapshot(writer.bytes());
}

}  // namespace egocal::services
