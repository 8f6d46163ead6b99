// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Sequences of messages, not single ones: what a stream and a pairing process remember from one to the next.
#pragma once

#include <cstddef>
#include <cstdint>

namespace egocal::fuzz {

/// Poses, interruptions and restarts into a Stream: none is lost without being counted, memory is bounded.
void try_stream(const std::uint8_t* data, std::size_t size);

/// Messages, commands and restarts into the whole of what egocal-pairing knows: PairSession and MotionPairing
/// behind the streams. A state that is written and read back continues with the same bits.
void try_pairing(const std::uint8_t* data, std::size_t size);

}  // namespace egocal::fuzz
