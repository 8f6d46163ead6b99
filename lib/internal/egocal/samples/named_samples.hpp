// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "egocal/samples/calibrate_samples.hpp"

namespace egocal {

/// How findings name samples, so that people find them where they have them.
struct SampleNames {
  std::vector<std::string> of;               ///< per sample, such as "7"; empty: their places, from 1
  std::string kind;                          ///< what the names are of, such as "row"; empty: samples
  std::string order = "in the order given";  ///< in which they were taken
};

/// The name of a sample alone, and with its kind: "7", "row 7".
std::string name_of(const SampleNames& names, std::size_t sample);
std::string full_name_of(const SampleNames& names, std::size_t sample);

/// calibrate_samples(), with findings in these names. Throws Error as that does. Thread-safe.
SampleCalibration calibrate_named_samples(std::span<const PoseSample> samples, const SampleOptions& options,
                                          const SampleNames& names);

}  // namespace egocal
