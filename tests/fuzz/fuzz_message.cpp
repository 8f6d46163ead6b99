// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// One message; EGOCAL_MESSAGE is its type.
#include "egocal/bus/decode.hpp"
#include "try_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  egocal::fuzz::try_message<EGOCAL_MESSAGE>({data, size});
  return 0;
}
