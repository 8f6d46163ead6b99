// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Numbers printed in Horn, Wodtko, Buchholz, Dietmayer, RA-L 2021, with their place in it.
#pragma once

namespace egocal::tools::paper {

/// A row of Table I or II: "Analytic [19]" is analytic [19] of comparison.hpp. Negative: a dash in the table.
struct TableRow {
  const char* method;
  double translation_cm, rotation_deg, milliseconds;
};

/// Table I, RGB-D data, 200 frames.
inline constexpr TableRow table_1[] = {{"analytic [19]", 1.08, 0.94, 0.2},
                                       {"local [7]", 1.20, 1.04, 1900.0},
                                       {"matrix [8]", 1.28, 1.06, 61.5},
                                       {"global", 1.16, 1.06, 43.9},
                                       {"fast", 1.16, 1.06, 6.2}};

/// Table II, KITTI odometry 04 to 10, 12,074 frames, three-dimensional. Of the analytic method "> 10^5" cm is
/// printed.
inline constexpr TableRow table_2_spatial[] = {{"analytic [19]", 1e5, 71.5, 4.2},
                                               {"matrix [8]", 17.84, 0.263, 62.7},
                                               {"global", 20.76, 0.257, 45.1},
                                               {"fast", 20.76, 0.257, 5.6}};
/// The same, planar.
inline constexpr TableRow table_2_planar[] = {{"global", 15.85, 0.355, 53.1}, {"fast", 15.84, 0.336, 3.7}};

inline constexpr int table_1_frames = 200, table_2_frames = 12074;          // the paper, tables I and II
inline constexpr int optimisations = 224448;                                ///< V-B
inline constexpr int noise_levels = 6, sizes = 167, sensors = 8, runs = 8;  ///< V-B
inline constexpr int sensor_pairs = sensors * (sensors - 1) / 2;           ///< 28: 6 x 167 x 28 x 8 = 224,448
inline constexpr int last_global_frame = 48;                               ///< Fig. 6
inline constexpr int online_frames = 150;                                  ///< Fig. 6
inline constexpr double fast_online_ms = 1.8, verify_ms = 0.05;            ///< V-E
inline constexpr double reliably_found_deg = 0.1, reliably_found_m = 0.1;  ///< V-F

}  // namespace egocal::tools::paper
