// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Short drives of nine machines in ten kinds of noise, on which standard deviations are measured.
#pragma once

#include <cstdint>

#include "support/simulated_drive.hpp"

namespace egocal::bench {

/// Turn rate and speed of a machine are smooth processes; poses every half second.
struct Machine {
  const char* name;
  double speed;      ///< mean, forwards [m/s]
  double variation;  ///< standard deviation of the speed in all three axes, or forwards where it has a ground
  double yaw;        ///< standard deviation of the rate [rad/s]
  double tilt;       ///< of the rates of roll and pitch
  double fades;      ///< after how long rates and speeds have changed [s]
  double stops;      ///< period of stop and go, turning while it stands [s]; 0: never
  bool has_ground;   ///< does not slide sideways; may be driven in the plane
};

inline constexpr Machine machines[] = {
    {"car", 8, 1.5, 0.25, 0.03, 2, 0, true},
    {"car that stops and goes", 6, 1.5, 0.3, 0.03, 2, 8, true},
    {"robot that turns in place", 1, 0.3, 0.7, 0.03, 2, 6, true},
    {"truck", 12, 1, 0.12, 0.02, 3, 0, true},
    {"tractor", 2.5, 0.5, 0.4, 0.06, 3, 0, true},
    {"drone", 3, 2, 0.5, 0.3, 1.5, 0, false},
    {"hand-held", 0, 0.6, 0.8, 0.8, 1, 0, false},
    {"free motion", 0.5, 1, 0.4, 0.4, 2, 0, false},
    {"boat", 3, 0.4, 0.2, 0.12, 1.5, 0, false},
};

/// What sizes are parts of: the mean rotation and translation of a motion, per axis.
struct DriveNoise {
  const char* name;
  double motions_a, motions_b;  ///< noise of every motion
  double poses_a, poses_b;      ///< noise of every pose
  double memory;                ///< of all of it [steps]; 0: white
  bool heavy_tails;             ///< Student's t of three degrees of freedom
  double of_each;               ///< a part of each motion instead of the mean one
};

inline constexpr DriveNoise drive_noises[] = {
    {"on motions", 0.03, 0.03, 0, 0, 0, false, 0},
    {"heavy tails", 0.03, 0.03, 0, 0, 0, true, 0},
    {"a part of each motion", 0, 0, 0, 0, 0, false, 0.05},
    {"on poses", 0, 0, 0.05, 0.05, 0, false, 0},
    {"on poses, memory of five steps", 0, 0, 0.05, 0.05, 5, false, 0},
    {"on motions 1 % and on poses 3 %", 0.01, 0.01, 0.03, 0.03, 0, false, 0},
    {"on motions of a 3 %, on poses of b 5 %", 0.03, 0, 0, 0.05, 0, false, 0},
    {"memory of four steps", 0.03, 0.03, 0, 0, 4, false, 0},
    {"memory of eight steps", 0.03, 0.03, 0, 0, 8, false, 0},
    {"memory of twenty steps", 0.03, 0.03, 0, 0, 20, false, 0},
};

/// Both sensors at any place of the machine. plane: without tilts, solved in planar mode.
testing::Streams noisy_drive(const Machine& machine, const DriveNoise& noise, int motions, bool plane,
                             std::uint64_t seed);

}  // namespace egocal::bench
