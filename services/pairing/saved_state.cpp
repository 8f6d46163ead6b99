// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing/saved_state.hpp"

#include <exception>
#include <utility>

#include "pairing/accumulation_fields.hpp"
#include "state/state_identity.hpp"

namespace egocal::services {

namespace {

void apply_all(std::span<const std::byte> inputs, Accumulation& accumulation) {
  Reader reader(inputs);
  while (!reader.done()) {
    Input input;
    std::uint32_t size = 0;
    reader(input.kind, input.index, size);
    input.bytes = reader.view(size);
    accumulation.apply(input);
    accumulation.take_motions();  // were sent before
  }
}

}  // namespace

SavedState::SavedState(const std::string& file, const bus::Rig& rig, StateFile::Clock clock,
                       const StateOptions& options)
    : SavedState(open_state_medium(file, options), rig, std::move(clock), options) {}

SavedState::SavedState(std::unique_ptr<StateMedium> medium, const bus::Rig& rig, StateFile::Clock clock,
                       const StateOptions& options)
    : options_(options),
      rig_(rig),
      file_(std::move(medium), state_identity("egocal-pairing", accumulation_layout, rig), std::move(clock),
            options) {}

Accumulation SavedState::restore() {
  Accumulation accumulation(rig_);
  if (const std::optional<StateFile::Content> content = file_.read()) {
    try {
      AccumulationState state;
      Reader reader(content->snapshot);
      reader(state);
      if (!reader.done()) throw Error("is damaged");
      accumulation.restore(std::move(state));
      for (const std::vector<std::byte>& inputs : content->additions) apply_all(inputs, accumulation);
      accumulation.settle();
      restored_ = true;
    } catch (const std::exception& error) {
      file_.refuse(error.what());
      accumulation = Accumulation(rig_);
    }
  }
  try {
    snapshot(accumulation);
  } catch (const Error& error) {
    not_saved_ = error.what();
  }
  return accumulation;
}

void SavedState::note(const Input& input) {
  if (broken_) return;
  inputs_(input.kind, input.index, static_cast<std::uint32_t>(input.bytes.size()));
  inputs_.raw(input.bytes.data(), input.bytes.size());
}

void SavedState::save(const Accumulation& accumulation) {
  if (broken_ || file_.added() >= options_.most_added || !file_.in_place()) return snapshot(accumulation);
  if (inputs_.bytes().empty()) return;
  broken_ = true;
  file_.add(inputs_.bytes());
  inputs_.clear();
  broken_ = false;
}

void SavedState::snapshot(const Accumulation& accumulation) {
  inputs_.clear();
  broken_ = true;
  Writer writer;
  writer(accumulation.state());
  file_.snapshot(writer.bytes());
  broken_ = false;
}

}  // namespace egocal::services
