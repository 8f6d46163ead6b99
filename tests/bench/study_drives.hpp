// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Drives on which verdicts are measured: simulated ones of every terrain and noise, and the real ones.
#pragma once

#include <string>
#include <vector>

#include "support/simulated_drive.hpp"

namespace egocal::bench {

struct StudyDrive {
  std::string name;
  std::string kind;  ///< row of the table of clean drives
  testing::Streams streams;
  bool truth = true;  ///< streams.T is known
};

enum class Noise { white, wandering, heavy_tailed, outliers };
constexpr Noise noises[] = {Noise::white, Noise::wandering, Noise::heavy_tailed, Noise::outliers};
constexpr Terrain terrains[] = {Terrain::flat, Terrain::rough, Terrain::free};
/// Drives of each seed: terrains x 3 levels of noise x kinds of noise.
constexpr std::size_t drives_per_seed = 36;

/// level: noise of each motion as a part of the mean one. Outliers: a twentieth of the poses of b. rate_b:
/// own rate of b [Hz], with stamps that are none of a's; 0: a's stamps. speed_variation: as of
/// SimulationOptions.
StudyDrive simulated_study_drive(Terrain terrain, double level, Noise noise, int poses, std::uint64_t seed,
                                 double rate_b = 0, double speed_variation = 0);

/// Every terrain, level (0.1, 1, 10 %) and kind of noise, in this order, for each seed from 1.
std::vector<StudyDrive> simulated_study_drives(int seeds, int poses, double rate_b = 0);

/// The same at speeds that vary: they stop, and go at thrice the speed, within a minute. Without the level of
/// 10 %, which hides what one row does.
std::vector<StudyDrive> study_drives_of_speeds(int seeds, int poses, double rate_b = 0);

/// Level evenly in the logarithm from 0.1 to 10 %, terrain and kind of noise alternately: drive i of a series
/// without end.
StudyDrive drive_of_series(std::size_t i, int poses, double rate_b = 0);

/// The drives of the data folder; empty where it is not there. few: KITTI 07 and EuRoC alone.
std::vector<StudyDrive> real_study_drives(bool few);

}  // namespace egocal::bench
