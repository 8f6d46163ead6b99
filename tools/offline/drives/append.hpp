// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "egocal/pairing/options.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::tools {

/// Several drives of the same sensors, one after the other in one trajectory a sensor.
class Drives {
 public:
  /// sensors: the first drive, read from these names. They must exist as long as this object.
  Drives(std::vector<Trajectory*> sensors, std::vector<std::string> names);

  /// Appends another drive, one trajectory a sensor, an hour after the end of what is there: no motion spans
  /// such a gap, so each drive may have an odometry frame of its own. A recording that is in already is no
  /// further evidence and is omitted; one that shares poses with it is not. `notes` report both.
  void append(std::vector<Trajectory> drive, std::vector<std::string> names, std::vector<std::string>& notes);

  std::size_t size() const { return drives_.size(); }
  /// The file of the first sensor.
  const std::string& name(std::size_t drive) const { return drives_[drive].names.front(); }
  /// What this drive gave to the stream of a sensor, with as many poses as were read.
  Trajectory part(const Trajectory& stream, std::size_t drive, std::size_t sensor) const;

  /// Where a time since the first pose of the first sensor is [s]: "12.3 s into b.tum", "that is
  /// between a.tum and b.tum". Empty of a single drive.
  std::string place_of(double seconds) const;

  /// The time of all drives as a part of that from the first begin to the last end, which has an hour between
  /// two of them. The time until a goal is reached is in proportion to the time driven.
  double driven_part() const;

  /// Throws Error where a drive gives two sensors no motion pair: it would be ignored without a word. a, b:
  /// the sensors' streams as they are paired, with as many poses as were read.
  void require_motions(std::size_t sensor_a, std::size_t sensor_b, const Trajectory& a, const Trajectory& b,
                       PairingOptions pairing) const;

 private:
  struct Drive {
    std::vector<std::string> names, spans;
    std::vector<std::size_t> begin;  ///< index of the first pose of each sensor
    double from = 0, to = 0;         ///< of the first sensor, since the first pose of all [s]
  };
  void note(std::vector<std::string> names, const std::vector<const Trajectory*>& drive,
            std::vector<std::size_t> begin, std::int64_t shift_us);
  struct Repeated {
    double part = 0;            ///< of the different poses of one drive: those that another one has as well
    std::int64_t shift_us = 0;  ///< what has to be added to their times [us]
  };
  Repeated repeated(const Trajectory& trajectory, std::size_t drive, std::size_t sensor) const;
  /// Whether all of the drive is in already.
  bool is_repeated(const std::vector<Trajectory>& drive, const std::vector<std::string>& names,
                   std::vector<std::string>& notes) const;
  std::vector<Trajectory*> sensors_;
  std::vector<Drive> drives_;
};

}  // namespace egocal::tools
