// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

namespace egocal::fuzz {

/// The bytes of a datagram through the decoder and the checks of its values. For the messages of the project.
template <class Message>
void try_message(std::span<const std::uint8_t> data);

}  // namespace egocal::fuzz
