// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What of each of pairing's structs goes into its state file, see state/state_fields.hpp.
#pragma once

#include "pairing/accumulation.hpp"
#include "state/state_fields.hpp"

namespace egocal::services {

/// Version of the fields below and of those that they hold. Raise it whenever either changes.
constexpr int accumulation_layout = 1000 * 1 + state_layout;

void fields(auto& archive, Is<EarlyPose> auto& value) {
  auto& [side, pose] = value;
  archive(side, pose);
}

void fields(auto& archive, Is<PairState> auto& value) {
  auto& [drive, scale, session, last_session, seq, restarted_by, early, paused] = value;
  archive(drive, scale, session, last_session, seq, restarted_by, early, paused);
}

void fields(auto& archive, Is<Refusals> auto& value) {
  auto& [times, apart] = value;
  archive(times, apart);
}

void fields(auto& archive, Is<ChannelState> auto& value) {
  auto& [stream, utime, in, undecodable, refused, refused_last, damaged] = value;
  archive(stream, utime, in, undecodable, refused, refused_last, damaged);
}

void fields(auto& archive, Is<AccumulationState> auto& value) {
  auto& [channels, pairs, rejected] = value;
  archive(channels, pairs, rejected);
}

}  // namespace egocal::services
