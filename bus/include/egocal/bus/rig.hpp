// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "egocal/diagnosis/verdict.hpp"
#include "egocal/geometry/dual_quaternion.hpp"
#include "egocal/pairing/motion_pairing.hpp"
#include "egocal/pairing/stream.hpp"
#include "egocal/problem/cost.hpp"
#include "egocal/problem/problem.hpp"

namespace egocal::bus {

enum class OdometryType { odometry, pose };  ///< egocal.odometry_t, bot_core.pose_t

struct Sensor {
  std::string name;     ///< letters, digits, _ and -; part of channel names
  std::string channel;  ///< of its odometry
  OdometryType type = OdometryType::odometry;
  std::optional<GroundPlane> plane{};
  double scale = 1;         ///< its lengths are multiplied by it, > 0: a camera without scale, another unit
  bool find_scale = false;  ///< scale = "auto": what is left of the scale is found from the motions
};

/// What follows where the mount is found to have moved during a session.
enum class OnMove {
  report,   ///< it is reported, and the answer is still that of the whole session
  restart,  ///< the calibration of the pair starts again by itself
};

/// Two sensors whose extrinsic is to be found, and what is known or wanted of it. The jack-knife chooses what
/// is "auto".
struct PairConfig {
  std::string a, b;  ///< names of sensors; T is the pose of b in a
  Mode mode = Mode::spatial;
  std::optional<Pose> truth;       ///< known extrinsic, for showing errors
  std::optional<Pose> nominal;     ///< mounting drawing: the prior in unobservable directions; NaN: not given
  std::optional<int> stride;       ///< empty: auto
  std::optional<Balance> balance;  ///< empty: auto
  bool robust = true;              ///< reject what is not screw congruent or contradicts the rest
  std::optional<double> time_offset = 0;  ///< [s] added to the stamps of b; empty: auto, found and followed
  std::optional<GoalOptions> goal;        ///< how well each direction is to be known; empty: none is stated
  OnMove on_move = OnMove::report;
  std::optional<Platform> platform;  ///< whose manoeuvres are advised; empty: as the motions look
};

struct Rig {
  std::string file;
  std::vector<Sensor> sensors;
  std::vector<PairConfig> pairs;
  double t_no_fail = 5.0;          ///< [s] Algorithm 1
  double max_gap = 0.5;            ///< [s] poses further apart are never interpolated between
  double reorder_window = 0.2;     ///< [s] a lost pose is waited for at most this long (measured time)
  double heartbeat_timeout = 3.0;  ///< [s] a process silent for longer counts as gone
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";
};

/// Reads a rig file (TOML, docs/rig.md). Throws Error naming file, line and key on anything that is not
/// understood: a misspelt key is an error, not ignored.
Rig read_rig(const std::string& file);
/// The text of a rig file alone, for parse_rig(): of a file that can be read only once. Throws Error where it
/// cannot be read.
std::string rig_text(const std::string& file);
/// The same from text; file is the name that errors carry.
Rig parse_rig(const std::string& text, const std::string& file);

/// Throws Error where the rig has no sensor of that name.
const Sensor& sensor(const Rig& rig, const std::string& name);

/// What pairing is to make of the rig's pair.
PairingOptions drive_options(const Rig& rig, const PairConfig& pair);
/// How the poses of each of the rig's sensors are put in order.
StreamOptions stream_options(const Rig& rig);
/// The side of the pair whose scale is to be found; empty: both scales are known.
std::optional<Side> unscaled_side(const Rig& rig, const PairConfig& pair);

}  // namespace egocal::bus
