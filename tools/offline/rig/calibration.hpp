// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/rig/rig.hpp"
#include "egocal/rig/rig_moves.hpp"
#include "offline/drives/mounts_of_drives.hpp"

namespace egocal::tools {

/// Three sensors and more: as files, as channels of a log, or as the sensors of a rig file.
struct RigRequest {
  std::vector<std::string> names, sources;  ///< one a sensor; of a rig file empty, then taken from there
  std::string rig;                          ///< its name
  std::vector<std::string> from;            ///< NAME=FILE, for a rig
  std::string log;                          ///< sources are its channels
  ReadOptions reading;                      ///< of all files
  std::vector<std::string> append;          ///< further drives, one file per sensor, in turn
  CalibrationOptions calibration;           ///< common to all pairs
  std::function<void(double)> progress;     ///< called with the part that is done, 0 to 1; one call at a time
  /// Called with the warnings where there is no answer that could hold them: they may say why.
  std::function<void(const std::vector<std::string>&)> unanswered;
};

/// Something that is wrong with one sensor, or with one of a pair.
struct RigFinding {
  std::string code;                   ///< as Finding::code, without _a and _b
  std::optional<std::size_t> sensor;  ///< the one that all pairs which show it have in common
  std::string message, remedy;
  std::optional<double> time;      ///< mount_moved: since the first pose of the first sensor [s]
  std::optional<double> value;     ///< as Finding::value, of the sensor; of b of the pair where none is named
  bool certain = true;             ///< as Finding::certain; an uncertain one blames no sensor
  std::size_t pair = 0;            ///< index of the pair that shows it best
  std::vector<std::size_t> pairs;  ///< indices of all that should not be used because of it
  std::optional<RigMove> move;     ///< mount_moved
};

/// Two sensors without an answer, and why.
struct UnsolvedPair {
  std::size_t a = 0, b = 0;
  std::string reason;
};

/// Two drives between which a mount of a pair was moved.
struct MountsOfPair {
  std::size_t pair = 0;  ///< index
  MountsDiffer differ;
};

struct RigReport {
  std::vector<std::string> names, sources;
  std::vector<Calibration> pairs;           ///< each with the answer of its own two streams
  std::vector<std::optional<Pose>> truths;  ///< of each of them, where the rig file has one
  std::vector<UnsolvedPair> unsolved;       ///< the others
  /// Sensors that no answer connects with the most of them, in ascending order: one that does not work has no
  /// answer at all. They are not in the tree.
  std::vector<std::size_t> apart;
  /// pairs: sensors, answer and certificate of those above, in their order. The rest is of the motions that
  /// several sensors have in common.
  RigSolution solution;
  bool joint = false;         ///< the tree is the joint minimum; otherwise the most certain pairs
  std::string why_not_joint;  ///< why not
  std::vector<MountsOfPair> mounts;
  std::vector<RigFinding> findings;
  std::optional<std::size_t> blamed;  ///< the sensor to blame
  std::vector<std::string> unusable;  ///< of each pair: why it should not be used; empty: nothing is known
  bool contradictory = false;         ///< an answer that should not be used
  bool short_of_goal = false;         ///< a pair is known less well than the rig file asks for
  std::vector<std::string> warnings;
};

/// Throws Error where a source cannot be read, or no pair has an answer; UsageError where options contradict.
RigReport calibrate_rig(const RigRequest& request);

}  // namespace egocal::tools
