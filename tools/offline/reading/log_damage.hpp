// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "egocal/bus/log_file.hpp"

namespace egocal::tools {

/// "the log is damaged: 249958 bytes in 1 region and at least 1 event are lost and in no answer; see egocal
/// log check"; empty: it is not. The numbers are what is certain: a damaged region holds any number of
/// events.
std::string damage_in_words(const bus::LogDamage& damage);

}  // namespace egocal::tools
